; A message that cannot come is a deadlock, not a wait for ever.
        recv2 v1, s1            ; trap: every core waits for another one

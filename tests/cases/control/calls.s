; A call leaves the address of the next instruction, in words.
        call s31, count         ; exit Taken; s31 = 1
        la   s1, count
        callr s31, s1           ; exit Taken; s31 = 4
        movi s31, done
        callr s1, s1            ; s1 = 6 -- the target is read before the link is written
done:   halt                    ; count: add 3, move 3, jump 7
count:  iaddi s2, s2, 1         ; s2 = 3
        ret  s31                ; exit Taken, Taken, Taken

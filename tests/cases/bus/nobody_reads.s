; A mailbox holds one message.
        send2 s0, v1
        send2 s0, v1            ; trap: every core waits for another one

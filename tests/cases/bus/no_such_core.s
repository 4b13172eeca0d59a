        movi s1, 1
        send2 s1, v1            ; trap: a message for core 1, where the largest number is 0

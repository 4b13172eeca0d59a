        send2 s0, v1
        recv5 v10, s1           ; trap: a message of 24 octets where one of 60 is received

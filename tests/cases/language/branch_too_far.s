        beq  s1, s2, .+32767
        beq  s1, s2, .+32768    ; error E009: the target is 32768 words away, beyond the reach of `beq`
        bwltz w1, .-32769       ; error E009: the target is -32769 words away, beyond the reach of `bwltz`
        call s31, .+(1 << 20)   ; error E009: the target is 1048576 words away, beyond the reach of `call`
        jump .-(1 << 25) - 1    ; error E009: the target is -33554433 words away, beyond the reach of `jump`
        jump .-(1 << 25)

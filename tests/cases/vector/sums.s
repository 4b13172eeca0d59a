; Saturates, one component at a time.
        .format pos, 16
        vset v1, 32767.5:pos, 0, -32768:pos, s1
        vset v2, 1:pos, 0, -1:pos, s1
        vadd v3, v1, v2         ; v3 = 32767.99998:pos, 0, -32768:pos
        vsub v4, v1, v2         ; v4 = 32766.5:pos, 0, -32767:pos
        vsub v5, v2, v1         ; v5 = -32766.5:pos, 0, 32767:pos
        vsub v6, v0, v1         ; v6 = -32767.5:pos, 0, 32767.99998:pos
        vadd v1, v1, v1         ; v1 = 0x7fffffff, 0, -0x80000000
        halt                    ; count: add 6, sub 9, move 16, jump 1

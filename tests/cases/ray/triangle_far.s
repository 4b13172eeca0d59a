; A distance beyond the word saturates, whatever the machine does with other overflows; decisions do not depend on the word.
; machine: arithmetic.word = 16
; machine: arithmetic.overflow = "WRAP"
        vset  v1, -0x8000, 0, 0, s1
        vset  v2, 1, 0, 0, s1
        vset  v3, 0x7fff, -9, -9, s1
        vset  v4, 0x7fff, 9, -9, s1
        vset  v5, 0x7fff, 0, 9, s1
        rtri  s2, v6, v1, v3, 0         ; exit Hit; s2 = 0x7fff; v6 = 0x1000, 0x2000, 0
        vset  v2, 4, 0, 0, s1
        rtri  s2, v6, v1, v3, 0         ; exit Hit; s2 = 16384 -- 65535 / 4
        rtri  s2, v6, v1, v3, 1         ; exit Hit; s2 = 0x7fff
        rtri  s2, v6, v1, v3, 63        ; exit Hit; s2 = 0x7fff
        halt

        .equ big, 1 << 63
        .equ sum, 0x7fffffffffffffff + 1
        .equ product, 0x7fffffffffffffff * 2
        .equ quotient, 5 / (3 - 3)
        .equ rest, 5 % 0
        .equ shifted, 1 << -1
        .equ most, -9223372036854775808 / -1
        movi s1, bits(-1)
        movi s1, big + sum

        add $s1, s2, s3
        movhi s1, %hi(table + 4)
        movi s1, %lo(table)
        lw s1, [s2+4]
        lw s1, [s2 - 4]
        movi s1, $5
        .include "lib\x.s"
        .include "lib\new.s"

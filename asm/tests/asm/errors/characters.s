        movi s1, 5 @ 3
kept:   add s1, s2, s3 $
        mov \a, s1
        j kept

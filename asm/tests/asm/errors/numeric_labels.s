        j 1b
1:      j 1f
        j 2f

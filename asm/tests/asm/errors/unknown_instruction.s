        vcros v1, v2, v3, 16
        ADD s1, s2, s3
loop
        frobnicate s1

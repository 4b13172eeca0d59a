; The larger of a number and its negation.
        neg  s8, a
        max  d, a, s8

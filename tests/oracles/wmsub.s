; A product and a difference.
        wmul w0, a, b
        wsub x, x, w0

; A product and a sum.
        wmul w0, a, b
        wadd x, x, w0

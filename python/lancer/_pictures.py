"""Picture files as arrays."""

import numpy


def read_picture(octets):
    """The linear colours of a PFM file, given as octets or by its path: an array of rows, columns and 3 components.

    Row 0 is on top. Components are those that the machine has computed, as 32-bit floating-point numbers.
    """
    if not isinstance(octets, (bytes, bytearray)):
        with open(octets, "rb") as file:
            octets = file.read()
    kind, size, scale, data = octets.split(b"\n", 3)
    if kind != b"PF":
        raise ValueError("a PFM file of three components is expected")
    width, height = map(int, size.split())
    order = "<f4" if float(scale) < 0 else ">f4"
    rows = numpy.frombuffer(data, dtype=order, count=width * height * 3).reshape(height, width, 3)
    # The format's rows go upwards.
    return rows[::-1].astype(numpy.float32)

"""The emulator lancer from Python: results as data frames, pictures as arrays.

Everything here calls the program `lancer` and reads its JSON; nothing is computed twice. The program is the one that
`lancer.program` or the environment variable LANCER names, else the one on the path.
"""

from ._command import LancerError, LancerWarning, arguments, call, program, version
from ._pictures import read_picture
from ._results import Render, diff, frame, machine, render, run, sweep

__all__ = [
    "LancerError",
    "LancerWarning",
    "Render",
    "arguments",
    "call",
    "diff",
    "frame",
    "machine",
    "program",
    "read_picture",
    "render",
    "run",
    "sweep",
    "version",
]

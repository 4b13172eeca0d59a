"""Calls of the program: options from keywords, messages as exceptions and warnings."""

import json
import os
import shutil
import subprocess
import warnings

#: Path of the program; None for the one of the variable LANCER, else the one on the path.
program = None


class LancerError(Exception):
    """A command that did not do its work: `code` is its exit code, `messages` are its messages as dictionaries."""

    def __init__(self, code, messages):
        self.code = code
        self.messages = messages
        super().__init__("\n".join(message.get("rendered", "") for message in messages) or f"exit code {code}")


class LancerWarning(UserWarning):
    """A warning of the program about an input."""


def _program():
    path = program or os.environ.get("LANCER") or shutil.which("lancer")
    if not path:
        raise FileNotFoundError("there is no program lancer: put it on the path, or set the variable LANCER to it")
    return path


def _text(name, value):
    """A value as the command line has it: `size=(160, 120)` is 160x120, other tuples and lists stand between commas."""
    if isinstance(value, (tuple, list)):
        return ("x" if name == "size" else ",").join(_text("", one) for one in value)
    return str(value)


def arguments(**options):
    """Words of a command line from keywords.

    `True` switches an option on, `False` and `None` leave it out; a dictionary repeats it, `format={"dir": 24}` is
    `--format dir=24`; `_` in a name is `-`.
    """
    words = []
    for name, value in options.items():
        option = "--" + name.rstrip("_").replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            words.append(option)
        elif isinstance(value, dict):
            for key, one in value.items():
                words += [option, f"{key}={_text('', one)}"]
        else:
            # Behind `=` a value may begin with a dash.
            words.append(f"{option}={_text(name, value)}")
    return words


def call(*words, input=None, allowed=(0,), **options):
    """Runs `lancer` and gives what it prints, as octets.

    Raises LancerError for an exit code that is not `allowed`; warnings of the program become Python's.
    """
    line = [_program(), *map(str, words), *arguments(**options), "--message-format", "json"]
    done = subprocess.run(line, input=input, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    messages = [_message(text) for text in done.stderr.decode("utf-8", "replace").splitlines() if text.strip()]
    if done.returncode not in allowed:
        raise LancerError(done.returncode, messages)
    for message in messages:
        if message.get("severity") == "warning":
            warnings.warn(message["rendered"], LancerWarning, stacklevel=3)
    return done.stdout


def _message(text):
    try:
        return json.loads(text)
    except ValueError:
        return {"severity": "error", "message": text, "rendered": text}


def version():
    """Version of the program, such as `0.1.0`."""
    done = subprocess.run([_program(), "--version"], stdout=subprocess.PIPE, check=True)
    return done.stdout.decode().split()[-1]

"""Results of commands: dictionaries as the program prints them, tables as data frames."""

import json
import os
import tempfile

import pandas

from ._command import call
from ._pictures import read_picture
from ._toml import document


class Render:
    """A picture and what it took; `data` is what `lancer render --json` prints."""

    def __init__(self, data, picture=None):
        self.data = data
        #: Linear colours, an array of rows, columns and 3 components; None where the picture was not asked for.
        self.picture = picture

    def __getitem__(self, key):
        return self.data[key]

    def __repr__(self):
        data = self.data
        return f"<Render {data['scene']} {data['width']} x {data['height']}, {data['clocks']} clocks>"

    @property
    def psnr(self):
        """PSNR against double precision in dB; infinite for an equal picture, None where it was not measured."""
        error = self.data["error"]
        if error is None:
            return None
        return float("inf") if error["psnr_db"] is None else error["psnr_db"]

    @property
    def functions(self):
        """Functions of the cores: calls, instructions, inclusive and exclusive operations by class."""
        return _table(self.data["functions"]).set_index("name")

    @property
    def cores(self):
        """Clocks of each core: busy, waiting, idle."""
        return pandas.DataFrame(self.data["cores"]).drop(columns="waits")


def _flat(value, path=""):
    """Numbers and texts of a result by their paths; lists are left out."""
    found = {}
    for key, one in value.items():
        name = f"{path}.{key}" if path else key
        if isinstance(one, dict):
            found.update(_flat(one, name))
        elif not isinstance(one, list):
            found[name] = one
    return found


def _table(rows):
    return pandas.DataFrame([_flat(row) for row in rows])


def frame(results):
    """One row a result, one column a key that holds a number or a text, such as `clocks` or `error.psnr_db`."""
    return _table([getattr(result, "data", result) for result in results])


def render(scene, picture=True, **options):
    """Draws a scene: `lancer.render("cornell", size=(160, 120), word=24, machine="wide32")`.

    Options are those of `lancer render`, with `_` for `-`. Without `picture` only the figures are computed.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "picture.pfm")
        if picture:
            options["output"] = path
        data = json.loads(call("render", scene, json=True, **options))
        return Render(data, read_picture(path) if picture else None)


def sweep(study, **keys):
    """Runs a study and gives its table, one row a point; docs/sweep.md describes studies and columns.

    `study` is the path of a study file (.toml), a dictionary with what such a file holds, or a scene or a list of them. In the
    last case keywords are keys of the settings, and lists of values are axes: `lancer.sweep(["cornell", "slabs"],
    word=[32, 24], cores=[1, 4], size=(32, 24))` has 8 points, of which those that differ in cores share a recording.
    """
    is_file = isinstance(study, (str, os.PathLike)) and str(study).endswith(".toml")
    if keys and (is_file or isinstance(study, dict)):
        raise TypeError("a study has its keys in itself")
    with tempfile.TemporaryDirectory() as folder:
        path = study
        if not is_file:
            if not isinstance(study, dict):
                study = _product(study, keys)
            path = os.path.join(folder, "study.toml")
            with open(path, "w", encoding="utf-8") as file:
                file.write(document(study))
        table = os.path.join(folder, "study.csv")
        call("sweep", path, output=table)
        return pandas.read_csv(table)


def _product(scenes, keys):
    """A study of every combination of the keys that are lists."""
    keys = {name.replace("_", "-"): value for name, value in keys.items() if value is not None}
    axes = {name: value for name, value in keys.items() if isinstance(value, list)}
    fixed = {name: value for name, value in keys.items() if name not in axes}
    scenes = list(scenes) if isinstance(scenes, (list, tuple)) else [scenes]
    return {"name": "sweep", "settings": fixed, "product": {"scene": scenes, **axes}}


def run(source, **options):
    """Runs a program on one core; `source` is a path, or the text of a program where it has a line feed."""
    is_text = "\n" in str(source)
    octets = call(
        "run", "-" if is_text else source, json=True, input=str(source).encode() if is_text else None, **options
    )
    return json.loads(octets)


def machine(name="report"):
    """All keys of a machine, by the name of a preset or the path of a file."""
    return json.loads(call("machine", name, json=True))["machine"]


def diff(a, b, **options):
    """What differs between two results or two dictionaries of settings: one row a key."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [os.path.join(folder, name) for name in ("a.json", "b.json")]
        for path, side in zip(paths, (a, b)):
            with open(path, "w", encoding="utf-8") as file:
                json.dump(getattr(side, "data", side), file)
        found = json.loads(call("diff", *paths, json=True, allowed=(0, 4), **options))
    columns = ["key", "part", "a", "b", "percent", "is_within"]
    return pandas.DataFrame(found["differences"], columns=columns).set_index("key")

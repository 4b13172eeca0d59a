"""Dictionaries as TOML, as far as studies need it."""

import json
import re


def document(tables):
    """A TOML document: values first, then a section for each dictionary, and one for each dictionary of a list of them."""
    lines, sections = [], []
    for name, value in tables.items():
        many = isinstance(value, list) and value and all(isinstance(one, dict) for one in value)
        if many or isinstance(value, dict):
            head = f"[[{_key(name)}]]" if many else f"[{_key(name)}]"
            for one in value if many else [value]:
                sections.append("\n".join(["", head, *(f"{_key(key)} = {_value(inner)}" for key, inner in one.items())]))
        else:
            lines.append(f"{_key(name)} = {_value(value)}")
    return "\n".join(lines + sections) + "\n"


def _key(name):
    """A key; one with dots stands for a key in a table."""
    return name if re.fullmatch(r"[A-Za-z0-9_.-]+", name) else json.dumps(name)


def _value(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(key)} = {_value(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(_value, value)) + "]"
    # Texts, whole numbers, real numbers and truth are written alike in JSON and TOML.
    return json.dumps(value, ensure_ascii=False)

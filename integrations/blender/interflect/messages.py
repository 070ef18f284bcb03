"""Messages of the command, in the terms of Blender's user. Independent of Blender."""

import re

NUMBER = r"(-?\d[\d.]*(?:e[+-]?\d+)?)"
PLACE = re.compile(rf"\bat \({NUMBER}, {NUMBER}, {NUMBER}\)")
WORLD = re.compile(r"'environment-\d+'")  # the command's name for a light without one


def for_blender(message: str, folder: str) -> str:
    """Converts places from the exported file's axes, with y up, to Blender's. Calls the environment the world, and
    files in the temporary folder by their names only."""
    message = PLACE.sub(lambda found: f"at ({found[1]}, {_negated(found[3])}, {found[2]})", message)
    return WORLD.sub("the world", message).replace(folder, "")


def _negated(number: str) -> str:
    if float(number) == 0:
        return "0"
    return number[1:] if number.startswith("-") else "-" + number

"""Blender's data as arrays."""

import numpy


def read(data, name: str, kind, width: int):
    """Returns a property of each item of a collection, such as the coordinates of vertices."""
    values = numpy.empty(len(data) * width, kind)
    data.foreach_get(name, values)
    return values.reshape(-1, width) if width > 1 else values

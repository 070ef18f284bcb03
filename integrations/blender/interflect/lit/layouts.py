"""Images for UV maps that are an object's own lightmap layout. Interflect moves such a layout into a larger image."""

from dataclasses import dataclass

import bpy
import numpy

TOLERANCE = 1e-5  # rounding of coordinates, in sides of the image
LEAST_SHARE = 0.1  # of its image that a layout covers; the command replaces smaller layouts


@dataclass
class Layout:
    """The map from an object's own coordinates (u, v, 1) to those in the larger image, and the latter's bounds."""

    matrix: numpy.ndarray  # 3 x 2
    lowest: numpy.ndarray
    highest: numpy.ndarray


def find(own, moved) -> Layout | None:
    """Returns the map from `own` to `moved`, if the coordinates are a layout that the command has kept."""
    if own.min() < -TOLERANCE or own.max() > 1 + TOLERANCE or numpy.prod(numpy.ptp(own, axis=0)) < LEAST_SHARE:
        return None
    rows = numpy.column_stack((own, numpy.ones(len(own)))).astype(float)
    matrix = numpy.linalg.lstsq(rows, moved.astype(float), rcond=None)[0]
    if numpy.abs(rows @ matrix - moved).max() > TOLERANCE:
        return None
    return Layout(matrix, moved.min(axis=0), moved.max(axis=0))


def cut(image, layout: Layout, name: str):
    """Returns a new image for an object's own coordinates, packed into the blend file. It has the resolution of the larger
    image."""
    size = numpy.array(image.size)
    texels = numpy.empty((size[1], size[0], 4), numpy.float32)
    image.pixels.foreach_get(texels.ravel())
    width, height = numpy.ceil(numpy.linalg.norm(layout.matrix[:2] * size, axis=1)).astype(int).tolist()
    v, u = numpy.meshgrid((numpy.arange(height) + 0.5) / height, (numpy.arange(width) + 0.5) / width, indexing="ij")
    places = numpy.stack((u, v, numpy.ones_like(u)), axis=-1) @ layout.matrix
    made = bpy.data.images.new(name, width, height, alpha=False, float_buffer=True)
    made.pixels.foreach_set(_interpolate(texels, numpy.clip(places, layout.lowest, layout.highest) * size - 0.5).ravel())
    made.pack()
    return made


def _interpolate(texels, places):
    """Returns the bilinear interpolation between texels at places (x, y) in texels."""
    last = numpy.array(texels.shape[1::-1]) - 1
    first = numpy.clip(numpy.floor(places), 0, numpy.maximum(last - 1, 0)).astype(int)
    (x, y), (right, up) = numpy.moveaxis(first, -1, 0), numpy.moveaxis(numpy.minimum(first + 1, last), -1, 0)
    a, b = numpy.moveaxis(numpy.clip(places - first, 0, 1).astype(numpy.float32), -1, 0)[..., None]
    return (1 - b) * ((1 - a) * texels[y, x] + a * texels[y, right]) + b * ((1 - a) * texels[up, x] + a * texels[up, right])

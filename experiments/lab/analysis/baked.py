"""Reads irradiance from the glTF files of `interflect export`, at points on surfaces."""

import json
import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .picture import LUMINANCE, read_exr

COMPONENTS = {5123: "<u2", 5125: "<u4", 5126: "<f4"}  # glTF's componentType
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
SAME_PLANE = 1e-4  # [m]; single precision of positions below 100 m


@dataclass(frozen=True)
class Baked:
    """Triangles with irradiance. `light(triangle, weights)` is the illuminance [lx] at barycentric coordinates."""

    corners: np.ndarray  # triangle x corner x axis [m]
    light: Callable[[np.ndarray, np.ndarray], np.ndarray]

    @property
    def normals(self) -> np.ndarray:
        a, b, c = self.corners.transpose(1, 0, 2)
        crossed = np.cross(b - a, c - a)
        return crossed / np.maximum(np.linalg.norm(crossed, axis=1, keepdims=True), 1e-30)

    def areas(self) -> np.ndarray:
        a, b, c = self.corners.transpose(1, 0, 2)
        return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2

    def at(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """Returns the illuminance at points of surfaces [lx]; 0 where no triangle faces this way, because exports omit
        dark surfaces."""
        low, high = self.corners.min(axis=1) - SAME_PLANE, self.corners.max(axis=1) + SAME_PLANE
        found = np.zeros(len(points))
        own = self.normals
        for k, (point, normal) in enumerate(zip(points, normals, strict=True)):
            near = np.flatnonzero((low <= point).all(axis=1) & (point <= high).all(axis=1))
            near = near[own[near] @ normal > 0.999]
            if not len(near):
                continue
            weights = self._weights(near, point)
            best = int(np.argmax(weights.min(axis=1)))  # the triangle that the point is least outside of
            if weights[best].min() > -0.01:
                found[k] = self.light(near[best : best + 1], np.clip(weights[best : best + 1], 0, 1))[0]
        return found

    def _weights(self, triangles: np.ndarray, point: np.ndarray) -> np.ndarray:
        a, b, c = self.corners[triangles].transpose(1, 0, 2)
        u, v, w = b - a, c - a, point - a
        uu, uv, vv = (u * u).sum(axis=1), (u * v).sum(axis=1), (v * v).sum(axis=1)
        wu, wv = (w * u).sum(axis=1), (w * v).sum(axis=1)
        determinant = np.maximum(uu * vv - uv**2, 1e-30)
        second, third = (vv * wu - uv * wv) / determinant, (uu * wv - uv * wu) / determinant
        return np.stack([1 - second - third, second, third], axis=1)


def read_baked(path: Path) -> Baked:
    """Reads a .glb file with irradiance in its vertices or lightmaps."""
    document, binary = chunks(path)
    parts = [p for mesh in document["meshes"] for p in mesh["primitives"]]
    indices = [array(document, binary, p["indices"]).reshape(-1, 3) for p in parts]

    def corners_of(attribute: str) -> np.ndarray:
        arrays = (array(document, binary, p["attributes"][attribute])[i] for p, i in zip(parts, indices))
        return np.concatenate(list(arrays)).astype(float)

    positions = corners_of("POSITION")
    if "_IRRADIANCE" in parts[0]["attributes"]:
        illuminance = corners_of("_IRRADIANCE") @ LUMINANCE
        return Baked(positions, lambda triangle, weights: (illuminance[triangle] * weights).sum(axis=1))
    maps = [read_exr(path.parent / name) @ LUMINANCE for name in lightmaps(document)]
    pages = np.concatenate([np.full(len(i), page(document, p)) for p, i in zip(parts, indices)])
    coordinates = corners_of("TEXCOORD_1")

    def light(triangle: np.ndarray, weights: np.ndarray) -> np.ndarray:
        places = (coordinates[triangle] * weights[:, :, None]).sum(axis=1)
        return np.array([bilinear(maps[page], place) for page, place in zip(pages[triangle], places)])

    return Baked(positions, light)


def bilinear(image: np.ndarray, place: np.ndarray) -> float:
    """Interpolates between the centres of texels; (0, 0) is the upper left corner of the image and (1, 1) the lower
    right."""
    height, width = image.shape
    x = np.clip(place[0] * width - 0.5, 0, width - 1)
    y = np.clip(place[1] * height - 0.5, 0, height - 1)
    left, top = min(int(x), max(width - 2, 0)), min(int(y), max(height - 2, 0))
    square = image[top : top + 2, left : left + 2]
    rows = square[0] + (y - top) * (square[-1] - square[0])
    return float(rows[0] + (x - left) * (rows[-1] - rows[0]))


def page(document: dict, primitive: dict) -> int:
    """Returns the index of a primitive's lightmap among the unclamped images, which have the names of the textures."""
    texture = document["materials"][primitive["material"]]["extensions"]["MOZ_lightmap"]["index"]
    name = document["images"][document["textures"][texture]["source"]]["name"]
    return [Path(file).stem for file in lightmaps(document)].index(name)


def lightmaps(document: dict) -> list[str]:
    return document["asset"]["extras"]["interflect"]["lightmap"]["unclamped"]


def chunks(path: Path) -> tuple[dict, bytes]:
    data = path.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + length]), data[20 + length + 8 :]


def array(document: dict, binary: bytes, index: int) -> np.ndarray:
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]  # the command writes no interleaved attributes
    begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    width = WIDTHS[accessor["type"]]
    values = np.frombuffer(binary, COMPONENTS[accessor["componentType"]], accessor["count"] * width, begin)
    return values.reshape(-1, width) if width > 1 else values

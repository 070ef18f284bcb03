"""Binary glTF files (.glb), beside Blender's exporter and importer."""

import json
import struct
from dataclasses import dataclass
from pathlib import Path

import numpy
from mathutils import Matrix, Quaternion

HEADERS = struct.Struct("<4sIIII")  # of the file and of its JSON
COMPONENTS = {5121: numpy.uint8, 5123: numpy.uint16, 5125: numpy.uint32, 5126: numpy.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
Z_UP = Matrix(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1)))  # turns the file's axes to Blender's


@dataclass
class ShownMesh:
    """A node that shows a mesh."""

    node: dict
    names: tuple[str, ...]  # of the nodes from its root to itself
    matrix: Matrix  # its place, with Blender's axes

    def owner(self, objects: dict):
        """Returns the scene's object that the node belongs to: an instancer of a collection above it, else the object
        with its name. Panels of area lamps have no owner."""
        above = [objects[name] for name in self.names if name in objects]
        return next((each for each in above if each.instance_type == "COLLECTION"), objects.get(self.names[-1]))


class GltfFile:
    def __init__(self, path: Path):
        data = path.read_bytes()
        length = HEADERS.unpack_from(data)[3]
        self.json = json.loads(data[HEADERS.size : HEADERS.size + length])
        self._binary = data[HEADERS.size + length :]  # with its header

    def write(self, path: Path) -> None:
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        size = HEADERS.size + len(text) + len(self._binary)
        kind = int.from_bytes(b"JSON", "little")
        path.write_bytes(HEADERS.pack(b"glTF", 2, size, len(text), kind) + text + self._binary)

    def array(self, accessor: int):
        """Returns the values of an accessor that is neither sparse nor interleaved."""
        accessor = self.json["accessors"][accessor]
        view = self.json["bufferViews"][accessor["bufferView"]]
        width = WIDTHS[accessor["type"]]
        start = 8 + view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        values = numpy.frombuffer(self._binary, COMPONENTS[accessor["componentType"]], accessor["count"] * width, start)
        return values.reshape(-1, width) if width > 1 else values

    def shown_meshes(self) -> list[ShownMesh]:
        nodes = self.json.get("nodes", [])
        children = {child for node in nodes for child in node.get("children", [])}
        waiting = [(node, (), Matrix()) for i, node in enumerate(nodes) if i not in children]
        shown = []
        while waiting:
            node, names, matrix = waiting.pop()
            names, matrix = (*names, node.get("name", "")), matrix @ _local_matrix(node)
            if "mesh" in node:
                shown.append(ShownMesh(node, names, Z_UP @ matrix @ Z_UP.inverted()))
            waiting += [(nodes[child], names, matrix) for child in node.get("children", [])]
        return shown


def _local_matrix(node: dict) -> Matrix:
    if "matrix" in node:
        columns = node["matrix"]
        return Matrix([columns[row::4] for row in range(4)])
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    return Matrix.LocRotScale(node.get("translation", (0, 0, 0)), Quaternion((w, x, y, z)), node.get("scale", (1, 1, 1)))

"""Writes and reads small GLB files for the tests of lightmaps."""

import json
import struct

import numpy as np

import interflect as ifl

HEADER, JSON_CHUNK, BINARY_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
COMPONENTS = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}


class Glb:
    """A GLB file: its JSON and its binary chunk."""

    def __init__(self, json_text=None, binary=b""):
        self.json = json_text or {"asset": {"version": "2.0"}, "accessors": [], "bufferViews": [], "nodes": []}
        self.binary = bytearray(binary)

    @classmethod
    def read(cls, path):
        data = path.read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        return cls(json.loads(data[20 : 20 + length]), data[20 + length + 8 :])

    def write(self, path):
        self.binary += bytes(-len(self.binary) % 4)
        self.json["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), JSON_CHUNK) + text
        chunks += struct.pack("<II", len(self.binary), BINARY_CHUNK) + self.binary
        path.write_bytes(struct.pack("<III", HEADER, 2, 12 + len(chunks)) + chunks)

    def add(self, values, bounds=False):
        """Adds an accessor, row by row; returns its index."""
        values = np.asarray(values)
        rows = values.reshape(len(values), -1)
        self.binary += bytes(-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": rows.nbytes}
        self.binary += rows.tobytes()
        self.json["bufferViews"].append(view)
        component = next(number for number, kind in COMPONENTS.items() if kind == rows.dtype)
        accessor = {"bufferView": len(self.json["bufferViews"]) - 1, "componentType": component, "count": len(rows)}
        accessor["type"] = TYPES[rows.shape[1]]
        if bounds:
            accessor |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def values(self, index):
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        kind = np.dtype(COMPONENTS[accessor["componentType"]])
        components = next(number for number, name in TYPES.items() if name == accessor["type"])
        first = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", components * kind.itemsize)
        rows = [np.frombuffer(self.binary, kind, components, first + i * stride) for i in range(accessor["count"])]
        return np.array(rows)

    def node(self, name):
        return next(node for node in self.json["nodes"] if node.get("name") == name)

    def primitives(self):
        """Yields (name of the node, its matrix, primitive) of the scene."""

        def visit(index, matrix):
            node = self.json["nodes"][index]
            matrix = matrix @ transform(node)
            for primitive in self.json["meshes"][node["mesh"]]["primitives"] if "mesh" in node else ():
                yield node["name"], matrix, primitive
            for child in node.get("children", ()):
                yield from visit(child, matrix)

        for root in self.json["scenes"][0]["nodes"]:
            yield from visit(root, np.eye(4))


def transform(node):
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    rotation = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix = np.eye(4)
    matrix[:3, :3] = np.array(rotation) * node.get("scale", (1, 1, 1))
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


class LitPoints:
    """Random points of a lit file's triangles: position, normal of the front, and irradiance from the lightmap, as a
    graphics card interpolates it."""

    def __init__(self, path, count=40):
        self.file = Glb.read(path)
        self.images = {}
        draw = np.random.default_rng(1)
        self.names, self.positions, self.normals, self.irradiance = [], [], [], []
        for name, matrix, primitive in self.file.primitives():
            material = self.file.json["materials"][primitive["material"]]
            lightmap = material["extensions"]["MOZ_lightmap"]
            image = self.image(path.parent, lightmap["index"])
            points = self.file.values(primitive["attributes"]["POSITION"]) @ matrix[:3, :3].T + matrix[:3, 3]
            coordinates = self.file.values(primitive["attributes"][f"TEXCOORD_{lightmap['texCoord']}"])
            for corners in self.file.values(primitive["indices"]).reshape(-1, 3).astype(int):
                for weights in draw.dirichlet((1, 1, 1), count):
                    a, b, c = points[corners]
                    normal = np.cross(b - a, c - a) * np.sign(np.linalg.det(matrix))
                    self.names.append(name)
                    self.positions.append(weights @ points[corners])
                    self.normals.append(normal / np.linalg.norm(normal))
                    self.irradiance.append(sample(image, weights @ coordinates[corners]))
        self.names, self.positions, self.normals = map(np.array, (self.names, self.positions, self.normals))
        self.irradiance = np.array(self.irradiance)

    def image(self, folder, texture):
        if texture not in self.images:
            source = self.file.json["images"][self.file.json["textures"][texture]["source"]]
            self.images[texture] = ifl.read_image(folder / f"{source['name']}.exr")
        return self.images[texture]


def sample(image, coordinate):
    """Interpolates between texel centres. The first row is the upper one, at v = 0."""
    height, width = image.shape[:2]
    x, y = coordinate * (width, height) - 0.5
    column, row = int(np.floor(x)), int(np.floor(y))
    s, t = x - column, y - row
    texels = image[row : row + 2, column : column + 2]
    return (1 - t) * ((1 - s) * texels[0, 0] + s * texels[0, 1]) + t * ((1 - s) * texels[1, 0] + s * texels[1, 1])

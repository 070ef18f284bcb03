"""Pipes, sockets, devices, folders and links in place of files: refused at once, or written to."""

import os
import socket

from case import BAD_INPUT, DONE, FAILED, WRONG_USAGE, Case
from seeds import PICTURES, RUN, SCENE, SOLUTION, TINY

READERS = {
    "info": (["info", "{}"], "room.mgf", SCENE),
    "info .h5": (["info", "{}"], "room.h5", SOLUTION),
    "validate": (["validate", "{}"], "room.mgf", SCENE),
    "solve": (["solve", "{}", "-o", "out.h5", "--rays", "1k"], "room.mgf", SCENE),
    "resume": (["resume", "{}", "-o", "out.h5"], "run.h5", RUN),
    "render": (["render", "{}", "-o", "out.png", "--view", "room-0", *TINY], "room.h5", SOLUTION),
    "render .mgf": (["render", "{}", "-o", "out.png", "--view", "room-0", "--rays", "1k", *TINY], "room.mgf", SCENE),
    "probe": (["probe", "{}", "--plane", "1", "--samples", "4"], "room.h5", SOLUTION),
    "report": (["report", "{}", "-o", "out.html"], "room.h5", SOLUTION),
    "export": (["export", "{}", "-o", "out.glb"], "room.h5", SOLUTION),
    "views": (["info", "room.mgf"], "room.views.json", SCENE),
    "view file": (["render", "room.h5", "-o", "out.png", "--view-file", "{}", *TINY], "corner.vf", (*SOLUTION, "corner.vf")),
    "luminaire": (["info", "room.mgf", "--luminaire", "{}@1,1,2"], "lamp.ies", (*SCENE, "lamp.ies")),
    "environment": (["info", "room.mgf", "--environment", "{}"], "a.hdr", (*SCENE, "a.hdr")),
    "environment .exr": (["info", "room.mgf", "--environment", "{}"], "a.exr", (*SCENE, "a.exr")),
    "compare": (["compare", "{}", "b.exr"], "a.exr", PICTURES),
    "compare reference": (["compare", "a.exr", "{}"], "a.hdr", PICTURES),
    "compare .png": (["compare", "a.exr", "{}"], "a.png", PICTURES),
    "texture": (["info", "textured.mgf"], "a.png", ("a.png",)),
    "include": (["info", "including.mgf"], "part.mgf", ("part.mgf",)),
    "ies": (["info", "lit.mgf"], "lamp.ies", ("lamp.ies",)),
    "mtl": (["info", "scene.obj"], "paint.mtl", ()),
    "map_Kd": (["info", "mapped.obj"], "a.png", ("a.png",)),
    "map_d": (["info", "masked.obj"], "a.png", ("a.png",)),
    "xform": (["info", "scene.rad"], "part.rad", ()),
    "buffer": (["info", "scene.gltf"], "scene.bin", ()),
    "checkpoint": (["solve", "room.mgf", "-o", "out.h5", "--rays", "1k", "--checkpoint", "run.h5"], "run.h5", SCENE),
    "previous": (["solve", "room.mgf", "-o", "out.h5", "--rays", "1k", "--checkpoint", "c.h5"], "c.previous.h5", SCENE),
    "made views": (["make-scene", "maze", "--rooms", "1", "-o", "made.mgf"], "made.views.json", ()),
}
OUTPUTS = ("checkpoint", "previous", "made views")
CORNERS = "".join(f"v v{k} =\n\tp {k % 2} {k // 2} 0\n\tuv {k % 2} {k // 2}\n" for k in range(4))
MGF = CORNERS + "m w =\n\tsides 2\n\trd .5\n\ted 1\n"
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
FILES = {
    "textured.mgf": MGF + "\ttexture rd a.png\nf v0 v1 v3 v2\n",
    "including.mgf": MGF + "f v0 v1 v3 v2\ni part.mgf\n",
    "lit.mgf": MGF + "f v0 v1 v3 v2\nies lamp.ies -t 0 0 1\n",
    "scene.obj": "mtllib paint.mtl\n" + OBJ + "f 1 2 3\n",
    "mapped.obj": "mtllib mapped.mtl\n" + OBJ + "usemtl m\nf 1/1 2/1 3/1\n",
    "mapped.mtl": "newmtl m\nmap_Kd a.png\n",
    "masked.obj": "mtllib masked.mtl\n" + OBJ + "usemtl m\nf 1/1 2/1 3/1\n",
    "masked.mtl": "newmtl m\nmap_d a.png\n",
    "scene.rad": "void light w 0 0 3 1 1 1\nw polygon p 0 0 9 0 0 0 1 0 0 0 1 0\n!xform part.rad\n",
    "scene.gltf": '{"asset": {"version": "2.0"}, "buffers": [{"uri": "scene.bin", "byteLength": 36}], "bufferViews": '
    '[{"buffer": 0, "byteLength": 36}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": '
    '"VEC3"}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}]}',
}
REFUSED_OR_IGNORED = frozenset({DONE, FAILED, WRONG_USAGE, BAD_INPUT})  # a missing library of OBJ is a warning


def make_socket(path):
    folder = os.open(path.parent, os.O_RDONLY)
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(f"/proc/self/fd/{folder}/{path.name}")  # at most 107 bytes
    os.close(folder)


WAYS = {
    "pipe": lambda path: os.mkfifo(path),
    "socket": make_socket,
    "folder": lambda path: path.mkdir(),
    "link to itself": lambda path: path.symlink_to(path.name),
    "link to nothing": lambda path: path.symlink_to("nothing"),
    "/dev/zero": lambda path: path.symlink_to("/dev/zero"),
    "/dev/full": lambda path: path.symlink_to("/dev/full"),
    "/dev/null": lambda path: path.symlink_to("/dev/null"),
    "/dev/stdin": lambda path: path.symlink_to("/dev/stdin"),
    "huge": lambda path: (path.touch(), os.truncate(path, 1 << 42)),
    "empty": lambda path: path.touch(),
}


def special(rng, seeds, number):
    names, ways = list(READERS), list(WAYS)
    name = names[number % len(names)]
    way = ways[(number // len(names) + number) % len(ways)]
    words, replaced, inputs = READERS[name]
    files = {**seeds.some(*inputs), **{key: text.encode() for key, text in FILES.items()}}
    files.pop(replaced, None)
    outputs = tuple(word for word in words if word.startswith("out."))
    # An output may replace an empty file, and follows a link.
    may_leave = ("c.h5", "made.mgf", "nothing", replaced) if name in OUTPUTS else ()
    return Case(
        description=f"{name}: {replaced} is {way}",
        arguments=[word.replace("{}", replaced) for word in words],
        files=files,
        allowed=REFUSED_OR_IGNORED,
        outputs=(),
        may_leave=(*outputs, *may_leave),
        prepare=lambda folder: WAYS[way](folder / replaced),
        memory=True,
    )

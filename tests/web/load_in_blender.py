"""Run by Blender: blender -b --factory-startup --python load_in_blender.py -- FILE...

Imports each glTF file into an empty scene and prints the result as a line of JSON.
"""

import json
import sys

import bpy
import numpy

numpy.bool = bool  # Blender 3.4 uses this name, which Debian's NumPy 1.24 no longer has


def imported(file):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=file)
    meshes = [o for o in bpy.data.objects if o.type == "MESH"]
    corners = [o.matrix_world @ v.co for o in meshes for v in o.data.vertices]
    return {
        "materials": sorted(m.name for m in bpy.data.materials),
        "cameras": sorted(o.name for o in bpy.data.objects if o.type == "CAMERA"),
        "triangles": sum(len(o.data.polygons) for o in meshes),
        "low": [min(c[k] for c in corners) for k in range(3)],
        "high": [max(c[k] for c in corners) for k in range(3)],
        "colours": sorted({a.name for o in meshes for a in o.data.color_attributes}),
        "uv_maps": sorted({u.name for o in meshes for u in o.data.uv_layers}),
    }


for file in sys.argv[sys.argv.index("--") + 1 :]:
    print("IMPORTED " + json.dumps(imported(file)))

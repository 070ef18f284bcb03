"""Run by Blender: blender -b --factory-startup --python load_in_blender.py -- FILE [CAMERA OUT.png]

Imports a glTF file, prints the result as a line of JSON, and renders it on request.
"""

import json
import sys

import bpy
import numpy

file, *picture = sys.argv[sys.argv.index("--") + 1 :]
numpy.bool = bool  # Blender 3.4 uses this name, which Debian's NumPy 1.24 no longer has
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=file)
meshes = [o for o in bpy.data.objects if o.type == "MESH"]
corners = [o.matrix_world @ v.co for o in meshes for v in o.data.vertices]
print(
    "IMPORTED "
    + json.dumps(
        {
            "objects": sorted(o.name for o in meshes),
            "materials": sorted(m.name for m in bpy.data.materials),
            "cameras": sorted(o.name for o in bpy.data.objects if o.type == "CAMERA"),
            "triangles": sum(len(o.data.polygons) for o in meshes),
            "low": [min(c[k] for c in corners) for k in range(3)],
            "high": [max(c[k] for c in corners) for k in range(3)],
            "colours": sorted({a.name for o in meshes for a in o.data.color_attributes}),
            "uv_maps": sorted({u.name for o in meshes for u in o.data.uv_layers}),
            "images": sorted(i.name for i in bpy.data.images),
        }
    )
)
if picture:
    scene = bpy.context.scene
    scene.camera = bpy.data.objects[picture[0]]
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 4
    scene.cycles.use_denoising = False
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y = 1280, 720
    scene.render.filepath = picture[1]
    bpy.ops.render.render(write_still=True)

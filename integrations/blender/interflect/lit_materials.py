"""Features of Interflect's files that Blender's glTF importer lacks: lightmaps, and the exposure of vertex colours."""

from math import pi
from pathlib import Path

import bpy

from . import versions

LIGHTMAP = "MOZ_lightmap"


class glTF2ImportUserExtension:
    """Called by Blender's importer for each new material. Ignores the materials of other programs' files."""

    def __init__(self):
        self.images = {}

    def gather_import_material_after_hook(self, gltf_material, vertex_color, material, importer):
        notes = (importer.data.asset.extras or {}).get("interflect")
        if notes is None:
            return
        lightmap = (gltf_material.extensions or {}).get(LIGHTMAP)
        if lightmap:
            self._light_by_image(material, lightmap, notes, importer)
        elif vertex_color:
            _undo_exposure(material, notes)

    def _light_by_image(self, material, lightmap, notes, importer):
        """Emits reflectance / pi times the irradiance of the unclamped image, in addition to the material's emission.
        """
        nodes, links = material.node_tree.nodes, material.node_tree.links
        surface = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
        coordinates, texture = nodes.new("ShaderNodeUVMap"), nodes.new("ShaderNodeTexImage")
        coordinates.uv_map = "UVMap" if lightmap["texCoord"] == 0 else f"UVMap.{lightmap['texCoord']:03}"
        texture.image = self._image(lightmap["index"], notes, importer)
        texture.extension = "EXTEND"
        links.new(coordinates.outputs["UV"], texture.inputs["Vector"])
        product = nodes.new("ShaderNodeMixRGB")
        product.blend_type = "MULTIPLY"
        product.inputs["Fac"].default_value = 1
        links.new(texture.outputs["Color"], product.inputs["Color2"])
        product.inputs["Color1"].default_value = surface.inputs["Base Color"].default_value
        for link in surface.inputs["Base Color"].links:
            links.new(link.from_socket, product.inputs["Color1"])
        reflected, emitted, both = (nodes.new(f"ShaderNode{kind}") for kind in ("Emission", "Emission", "AddShader"))
        links.new(product.outputs["Color"], reflected.inputs["Color"])
        reflected.inputs["Strength"].default_value = 1 / pi
        of_surface = versions.emission_colour(surface), surface.inputs["Emission Strength"]
        for socket, to in zip(of_surface, (emitted.inputs["Color"], emitted.inputs["Strength"])):
            to.default_value = socket.default_value
            for link in socket.links:
                links.new(link.from_socket, to)
        # The exposure brightened the emission, like the 8-bit images.
        emitted.inputs["Strength"].default_value *= 2 ** -notes["exposure"]
        links.new(reflected.outputs[0], both.inputs[0])
        links.new(emitted.outputs[0], both.inputs[1])
        _output(nodes, links, both)

    def _image(self, index, notes, importer):
        """Returns the unclamped image of a texture, packed into the blend file."""
        name = importer.data.images[importer.data.textures[index].source].name
        if name not in self.images:
            file = next(file for file in notes["lightmap"]["unclamped"] if Path(file).stem == name)
            image = bpy.data.images.load(str(Path(importer.filename).parent / file))
            image.pack()
            self.images[name] = image
        return self.images[name]


def _undo_exposure(material, notes):
    """Undoes the exposure of vertex colours, which the importer shows as in the file, times the texture if there is
    one."""
    nodes = material.node_tree.nodes
    emission = next(node for node in nodes if node.type == "EMISSION")
    emission.inputs["Strength"].default_value = 2 ** -notes["exposure"]
    _output(nodes, material.node_tree.links, emission)


def _output(nodes, links, shader):
    """Shows front sides only: each side of a face has its own light, and lit_sides.py moves it in front of the other."""
    side, through, shown = (nodes.new(f"ShaderNode{kind}") for kind in ("NewGeometry", "BsdfTransparent", "MixShader"))
    links.new(side.outputs["Backfacing"], shown.inputs["Fac"])
    links.new(shader.outputs[0], shown.inputs[1])
    links.new(through.outputs[0], shown.inputs[2])
    output = next(node for node in nodes if node.type == "OUTPUT_MATERIAL")
    links.new(shown.outputs[0], output.inputs["Surface"])

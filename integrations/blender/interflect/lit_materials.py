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
        is_authored = not (importer.data.asset.generator or "").startswith("Interflect")
        if is_authored:
            for surface in [node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED"]:
                surface.inputs["Emission Strength"].default_value *= 2 ** -notes["exposure"]
                if lightmap:
                    self._light_authored(material, surface, lightmap, notes, importer)
        elif lightmap:
            self._light_by_image(material, lightmap, notes, importer)
        elif vertex_color:
            _undo_exposure(material, notes)

    def _light_authored(self, material, surface, lightmap, notes, importer):
        """Replaces diffuse reflection in a material of the author's file by the lightmap, as emission. Reflections, glass
        and transparency stay."""
        nodes, links = material.node_tree.nodes, material.node_tree.links

        def made(kind, operation, *inputs):
            node = nodes.new(f"ShaderNode{kind}")
            setattr(node, "operation" if kind == "Math" else "blend_type", operation)
            for socket, value in zip(node.inputs, inputs):
                _feed(links, value, socket)
            return node.outputs[0]

        metallic, transmission = surface.inputs["Metallic"], versions.transmission(surface)
        opaque = made("Math", "SUBTRACT", 1, transmission)
        diffuse = made("Math", "MULTIPLY", made("Math", "SUBTRACT", 1, metallic), opaque)
        colour = surface.inputs["Base Color"]
        emission, both = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeAddShader")
        image = self._texture(nodes, links, lightmap, notes, importer)
        links.new(made("MixRGB", "MULTIPLY", 1, colour, image), emission.inputs["Color"])
        shown = made("Math", "MULTIPLY", diffuse, surface.inputs["Alpha"])
        links.new(made("Math", "DIVIDE", shown, pi), emission.inputs["Strength"])
        links.new(made("MixRGB", "MIX", diffuse, colour, (0, 0, 0, 1)), colour)
        shown_by = [link.to_socket for link in surface.outputs[0].links]
        links.new(surface.outputs[0], both.inputs[0])
        links.new(emission.outputs[0], both.inputs[1])
        for socket in shown_by:
            links.new(both.outputs[0], socket)
        versions.hide_from_sampling(material)

    def _light_by_image(self, material, lightmap, notes, importer):
        """Emits reflectance / pi times the irradiance of the unclamped image, in addition to the material's emission.
        """
        nodes, links = material.node_tree.nodes, material.node_tree.links
        surface = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
        product = nodes.new("ShaderNodeMixRGB")
        product.blend_type = "MULTIPLY"
        product.inputs["Fac"].default_value = 1
        links.new(self._texture(nodes, links, lightmap, notes, importer), product.inputs["Color2"])
        _feed(links, surface.inputs["Base Color"], product.inputs["Color1"])
        reflected, emitted, both = (nodes.new(f"ShaderNode{kind}") for kind in ("Emission", "Emission", "AddShader"))
        links.new(product.outputs["Color"], reflected.inputs["Color"])
        reflected.inputs["Strength"].default_value = 1 / pi
        of_surface = versions.emission_colour(surface), surface.inputs["Emission Strength"]
        for socket, to in zip(of_surface, (emitted.inputs["Color"], emitted.inputs["Strength"])):
            _feed(links, socket, to)
        # The exposure brightened the emission, like the 8-bit images.
        emitted.inputs["Strength"].default_value *= 2 ** -notes["exposure"]
        links.new(reflected.outputs[0], both.inputs[0])
        links.new(emitted.outputs[0], both.inputs[1])
        _output(nodes, links, both)

    def _texture(self, nodes, links, lightmap, notes, importer):
        """Returns the irradiance of the unclamped image, as the output of a node."""
        coordinates, texture = nodes.new("ShaderNodeUVMap"), nodes.new("ShaderNodeTexImage")
        coordinates.uv_map = "UVMap" if lightmap["texCoord"] == 0 else f"UVMap.{lightmap['texCoord']:03}"
        texture.image = self._image(lightmap["index"], notes, importer)
        texture.extension = "EXTEND"
        links.new(coordinates.outputs["UV"], texture.inputs["Vector"])
        return texture.outputs["Color"]

    def _image(self, index, notes, importer):
        """Returns the unclamped image of a texture, packed into the blend file."""
        name = importer.data.images[importer.data.textures[index].source].name
        if name not in self.images:
            file = next(file for file in notes["lightmap"]["unclamped"] if Path(file).stem == name)
            image = bpy.data.images.load(str(Path(importer.filename).parent / file))
            image.pack()
            self.images[name] = image
        return self.images[name]


def _feed(links, value, socket):
    """Sets an input to a number or colour, to the output of a node, or to the value of another input."""
    if isinstance(value, bpy.types.NodeSocket) and value.is_output:
        links.new(value, socket)
    elif isinstance(value, bpy.types.NodeSocket):
        socket.default_value = value.default_value
        for link in value.links:
            links.new(link.from_socket, socket)
    else:
        socket.default_value = value


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

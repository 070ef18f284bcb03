"""Materials that show light: features of Interflect's files that Blender's glTF importer lacks (lightmaps, and the exposure
of vertex colours), and lightmaps in the scene's own materials."""

from math import pi
from pathlib import Path

import bpy

from .. import result, versions

LIGHTMAP = "MOZ_lightmap"
UNNAMED_REFLECTANCE = 0.8  # of surfaces without a material in Blender


class glTF2ImportUserExtension:
    """Called by Blender's importer for each new material. Ignores the materials of other programs' files."""

    def __init__(self):
        self.images = None

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
                    _light_surface(material.node_tree, surface, self._irradiance(material, lightmap, notes, importer))
                    versions.hide_from_sampling(material)
        elif lightmap:
            _light_by_image(material, self._irradiance(material, lightmap, notes, importer), notes)
        elif vertex_color:
            _undo_exposure(material, notes)

    def _irradiance(self, material, lightmap, notes, importer):
        self.images = self.images or UnclampedImages(Path(importer.filename).parent, notes)
        name = importer.data.images[importer.data.textures[lightmap["index"]].source].name
        uv_map = "UVMap" if lightmap["texCoord"] == 0 else f"UVMap.{lightmap['texCoord']:03}"
        return _texture(material.node_tree, self.images.load(name), uv_map)


class UnclampedImages:
    """The images beside a file, packed into the blend file."""

    def __init__(self, folder: Path, notes: dict):
        """@param notes  The file's `asset.extras.interflect`."""
        self._paths = {Path(file).stem: folder / file for file in notes["lightmap"]["unclamped"]}
        self._loaded = {}

    def load(self, name: str):
        """Returns the unclamped image of the file's image with this name."""
        if name not in self._loaded:
            image = self._loaded[name] = bpy.data.images.load(str(self._paths[name]))
            image.pack()
        return self._loaded[name]


def light_copy(original, image, uv_map: str):
    """Returns a copy of a material that shows an image of irradiance in place of diffuse reflection.
    @param original  The material, if the surface has one."""
    lit = original.copy() if original else bpy.data.materials.new("lit")
    if original:
        lit.name, lit[result.ORIGINAL] = f"{original.name} lit", original
    if not (original and original.use_nodes):
        _use_nodes(lit, original)
    _light_tree(lit.node_tree, image, uv_map)
    versions.hide_from_sampling(lit)
    return lit


def _use_nodes(lit, original):
    """Replaces the nodes of a material that does not use them by its colour, metal and roughness."""
    lit.use_nodes = True
    nodes = lit.node_tree.nodes
    nodes.clear()
    surface, output = nodes.new("ShaderNodeBsdfPrincipled"), nodes.new("ShaderNodeOutputMaterial")
    lit.node_tree.links.new(surface.outputs[0], output.inputs["Surface"])
    inputs = surface.inputs
    inputs["Base Color"].default_value = original.diffuse_color if original else (*[UNNAMED_REFLECTANCE] * 3, 1)
    if original:
        inputs["Metallic"].default_value, inputs["Roughness"].default_value = original.metallic, original.roughness


def _light_tree(tree, image, uv_map):
    for node in list(tree.nodes):
        if node.type in ("BSDF_PRINCIPLED", "BSDF_DIFFUSE"):
            _light_surface(tree, node, _texture(tree, image, uv_map))
        elif node.type == "GROUP" and node.node_tree:
            node.node_tree = node.node_tree.copy()
            _light_tree(node.node_tree, image, uv_map)


def _light_surface(tree, surface, irradiance):
    """Replaces diffuse reflection of a shader by the reflected irradiance, as emission. Reflections, glass and
    transparency stay."""
    nodes, links = tree.nodes, tree.links

    def made(kind, operation, *inputs):
        node = nodes.new(f"ShaderNode{kind}")
        setattr(node, "operation" if kind == "Math" else "blend_type", operation)
        for socket, value in zip(node.inputs, inputs):
            _feed(links, value, socket)
        return node.outputs[0]

    if surface.type == "BSDF_DIFFUSE":
        colour, diffuse, alpha = surface.inputs["Color"], 1, 1
    else:
        colour, alpha = surface.inputs["Base Color"], surface.inputs["Alpha"]
        opaque = made("Math", "SUBTRACT", 1, versions.transmission(surface))
        diffuse = made("Math", "MULTIPLY", made("Math", "SUBTRACT", 1, surface.inputs["Metallic"]), opaque)
    emission, both = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeAddShader")
    links.new(made("MixRGB", "MULTIPLY", 1, colour, irradiance), emission.inputs["Color"])
    shown = made("Math", "MULTIPLY", diffuse, alpha)
    links.new(made("Math", "DIVIDE", shown, pi), emission.inputs["Strength"])
    links.new(made("MixRGB", "MIX", diffuse, colour, (0, 0, 0, 1)), colour)
    shown_by = [link.to_socket for link in surface.outputs[0].links]
    links.new(surface.outputs[0], both.inputs[0])
    links.new(emission.outputs[0], both.inputs[1])
    for socket in shown_by:
        links.new(both.outputs[0], socket)


def _light_by_image(material, irradiance, notes):
    """Emits reflectance / pi times the irradiance, in addition to the material's emission."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    surface = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    product = nodes.new("ShaderNodeMixRGB")
    product.blend_type = "MULTIPLY"
    product.inputs["Fac"].default_value = 1
    links.new(irradiance, product.inputs["Color2"])
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


def _texture(tree, image, uv_map: str):
    """Returns the colour of an image, as the output of a node."""
    coordinates, texture = tree.nodes.new("ShaderNodeUVMap"), tree.nodes.new("ShaderNodeTexImage")
    coordinates.uv_map = uv_map
    texture.image = image
    texture.extension = "EXTEND"
    tree.links.new(coordinates.outputs["UV"], texture.inputs["Vector"])
    return texture.outputs["Color"]


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
    """Undoes the exposure of vertex colours, which the importer multiplies by the texture, if any."""
    nodes = material.node_tree.nodes
    emission = next(node for node in nodes if node.type == "EMISSION")
    emission.inputs["Strength"].default_value = 2 ** -notes["exposure"]
    _output(nodes, material.node_tree.links, emission)


def _output(nodes, links, shader):
    """Shows front sides only: each side of a face has its own light, and sides.py moves it in front of the other."""
    side, through, shown = (nodes.new(f"ShaderNode{kind}") for kind in ("NewGeometry", "BsdfTransparent", "MixShader"))
    links.new(side.outputs["Backfacing"], shown.inputs["Fac"])
    links.new(shader.outputs[0], shown.inputs[1])
    links.new(through.outputs[0], shown.inputs[2])
    output = next(node for node in nodes if node.type == "OUTPUT_MATERIAL")
    links.new(shown.outputs[0], output.inputs["Surface"])

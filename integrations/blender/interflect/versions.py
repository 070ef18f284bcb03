"""Names that differ between Blender's versions, which are looked up: 3.4 to 5.0 are tested."""

import math
import sys

import bpy
import numpy

if bpy.app.version < (3, 5):
    numpy.bool = bool  # the importer uses this name, which later versions of NumPy have dropped


class UnknownVersion(RuntimeError):
    """Blender lacks everything that the add-on knows by another name."""

    def __init__(self, missing: str):
        super().__init__(
            f"Blender {bpy.app.version_string} has no {missing}: the add-on is for versions 3.4 to 5.0. "
            "Look for a newer version of Interflect"
        )


def emission_colour(surface):
    """Returns the input of a Principled BSDF for the colour of its emission."""
    for name in ("Emission Color", "Emission"):  # since Blender 4.0, before
        if name in surface.inputs:
            return surface.inputs[name]
    raise UnknownVersion("colour of emission in the Principled BSDF")


def transmission(surface):
    """Returns the input of a Principled BSDF for the share of glass."""
    for name in ("Transmission Weight", "Transmission"):  # since Blender 4.0, before
        if name in surface.inputs:
            return surface.inputs[name]
    raise UnknownVersion("share of transmission in the Principled BSDF")


def hide_from_sampling(material) -> None:
    """Makes Cycles find the emission of a material by chance, in place of aiming rays at it as at a lamp."""
    settings = getattr(material, "cycles", None)
    if hasattr(settings, "emission_sampling"):  # since Blender 3.5
        settings.emission_sampling = "NONE"
    elif hasattr(settings, "sample_as_light"):
        settings.sample_as_light = False


def watts_as_lumens(operator) -> dict[str, str]:
    """Returns the option of the glTF exporter or importer that keeps the numbers of lamps."""
    properties = operator.get_rna_type().properties
    for name in ("export_import_convert_lighting_mode", "convert_lighting_mode"):  # since Blender 3.6, before
        if name in properties:
            return {name: "COMPAT"}
    raise UnknownVersion("lighting mode of glTF files")


def area_lamp_radiance() -> float:
    """Returns the radiance that Cycles gives an area lamp, over watts and area. Measured in Blender 3.4, where the lamp
    emits 0.785 of its watts, and in 4.2, 4.5 and 5.0."""
    return 1 / 4 if bpy.app.version < (4, 0) else 1 / math.pi


def background_command() -> list[str]:
    """Returns a command that runs a script, which follows, in another Blender."""
    if bpy.app.binary_path:
        return [bpy.app.binary_path, "--background", "--factory-startup", "--python-exit-code", "1", "--python"]
    return [sys.executable]  # with Blender as a Python module

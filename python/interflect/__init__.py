"""Diffuse global illumination that goes where the camera looks. A picture of a scene::

    import interflect as ifl

    solution = ifl.solve("scenes/office.mgf", view="desk", rays=5e6)
    picture = ifl.render(solution)            # float32 (720, 1280, 3), cd/m^2
    ifl.write_image("desk.png", picture)

Lengths are in metres, light in photometric or radiometric units, as the scene has them. Colours are linear Rec. 709:
tuples of three numbers, or one number for grey; points and directions are tuples of three numbers. Objects of plain
data, such as a View, take their attributes by position or by name; they have replace(), ==, copies and
pickle. The same seed gives the same bits for any number of threads, and the bits of the command `interflect`. Arrays
of scenes and solutions are read-only and not copied. Calls that take long release the lock of the interpreter; Ctrl-C
ends them.
"""

from interflect._core import (
    AdvanceReport, BlockDifference, CieSky, Consistency, Daylight, Deviation, DirectionalLight, Elements, Environment,
    EnvironmentMap, Escapes, Finding,
    FindingPlace, GlareRating, GlareSource, IlluminanceSummary, ImageDifference, LightGroup, Luminaire, Material, MaterialSummary,
    MeasuredLight, MeasuringGrid, Measurement, OneWayLight, PerezSky, PhotometricWeb, PlacedLuminaire, PlanarArea,
    PointLight, PowerBalance, Progress, Reconciliation, Rendering, Scene, SceneSummary, SkyDome, SkyModel, Solution, SpotLight, Sun, Texture, UniformSky, View,
    ViewFactors, WeightedView, area_grid, automatic_exposure, cie_standard_sky, compare, cut_at_contacts, export_scene, find_floor,
    find_surface, find_top, grid_spacing, groups_by_name, line_grid, load_photometric_web, none, overview, read_image,
    read_radiance_view, summarise, validate, write_image,
)
from interflect._core import version as __version__
from interflect._errors import Error, Fault, InputError, Stopped, TooManyPatches, Warning
from interflect._pictures import export, preview, probe, rate_glare, render, tonemap, trace
from interflect._scenes import load
from interflect._solving import Solver, open_solution, solve
from interflect._view_factors import view_factors

__all__ = [
    "AdvanceReport", "BlockDifference", "CieSky", "Consistency", "Daylight", "Deviation", "DirectionalLight", "Elements", "Environment",
    "EnvironmentMap", "Error", "Escapes", "Fault", "Finding", "FindingPlace", "GlareRating", "GlareSource", "IlluminanceSummary",
    "ImageDifference", "InputError", "LightGroup", "Luminaire", "Material", "MaterialSummary", "MeasuredLight", "MeasuringGrid", "Measurement", "OneWayLight",
    "PerezSky", "PhotometricWeb", "PlacedLuminaire", "PlanarArea", "PointLight", "PowerBalance", "Progress",
    "Reconciliation", "Rendering", "Scene", "SceneSummary", "SkyDome", "SkyModel", "Solution", "Solver", "SpotLight", "Stopped", "Sun", "Texture", "TooManyPatches",
    "UniformSky", "View", "ViewFactors", "Warning", "WeightedView", "__version__", "area_grid", "automatic_exposure", "cie_standard_sky",
    "compare", "cut_at_contacts", "export", "export_scene", "find_floor", "find_surface", "find_top", "grid_spacing",
    "groups_by_name", "line_grid", "load", "load_photometric_web", "none", "open_solution", "overview", "preview", "probe",
    "rate_glare", "read_image", "read_radiance_view", "render", "solve", "summarise", "tonemap", "trace", "validate",
    "view_factors", "write_image",
]

# Messages and help() show the names under which users find these.
for _name in __all__:
    if hasattr(globals()[_name], "__module__"):
        globals()[_name].__module__ = __name__

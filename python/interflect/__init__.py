"""Diffuse global illumination that goes where the camera looks.

    import interflect as ifl
    solution = ifl.solve("scenes/office.mgf", view="desk", rays=5e6)
    picture = ifl.render(solution)            # float32 (720, 1280, 3), cd/m^2
    ifl.write_image("desk.png", picture)

Lengths are in metres, colours linear Rec. 709, light in photometric or radiometric units, as the scene has them. The same
seed gives the same bits for any number of threads, and the bits of the command `interflect`. Arrays of scenes and solutions
are read-only and not copied. Calls that take long release the lock of the interpreter; Ctrl-C ends them.
"""

from interflect._core import (
    AdvanceReport, CieSky, Consistency, Daylight, Deviation, DirectionalLight, Elements, Environment, EnvironmentMap, Finding, FindingPlace,
    GlareRating, GlareSource, IlluminanceSummary, ImageDifference, LightGroup, Luminaire, Material, MeasuredLight,
    MeasuringGrid, Measurement, PathTracing, PerezSky, PhotometricWeb, PlacedLuminaire, PlanarArea, PointLight,
    PowerBalance, Progress, Reconciliation, Scene, SkyDome, SkyModel, Solution, SpotLight, Sun, Texture, UniformSky, View, WeightedView,
    area_grid, automatic_exposure, cie_standard_sky, compare, cut_at_contacts, export_scene, find_floor, find_surface,
    find_top, grid_spacing, groups_by_name, line_grid, load_photometric_web, none, overview, rate_glare, read_image,
    validate, write_image,
)
from interflect._core import version as __version__
from interflect._errors import Error, InputError, Stopped, TooManyPatches, Warning
from interflect._pictures import export, probe, render, tonemap, trace
from interflect._scenes import load
from interflect._solving import Solver, open_solution, solve
from interflect._view_factors import ViewFactors, view_factors

__all__ = sorted(name for name in dir() if not name.startswith("_"))

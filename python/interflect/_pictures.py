"""Pictures, measurements and exports of a solution."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from interflect import _core
from interflect._errors import InputError
from interflect._progress import ProgressArgument, reporting
from interflect._scenes import scene_of

# Formats with 8-bit colours, for which export() computes the automatic exposure.
COLOUR_FORMATS = (".glb", ".gltf", ".ply", ".obj")
PICTURE = _core.PictureOptions()  # with the defaults of the library
MEASURING = _core.MeasuringOptions()
ViewArgument = _core.View | str | None
LitArgument = _core.Solution | _core.Scene | str | os.PathLike[str]


def _lit(lit: LitArgument, shading: str) -> _core.Solution | _core.Scene:
    if isinstance(lit, _core.Solution):
        return lit
    if _core.needs_solution(shading):
        raise TypeError(f"{shading} shading needs a Solution: expected the result of solve(), found {lit!r}")
    return _core.cut_at_contacts(scene_of(lit))  # as the command does


def _draw(lit: LitArgument, view: ViewArgument, options: _core.PictureOptions, threads: int,
          progress: ProgressArgument) -> _core.Rendering:
    source = _lit(lit, options.shading)
    if view is None and isinstance(source, _core.Solution) and source.views:
        view = source.views[0].view  # for which the solution was made
    with reporting(progress, "drawing") as report:
        return _core.render(source, view, options, threads, report)


def render(lit: LitArgument, view: ViewArgument = None, *, width: int = PICTURE.width, height: int = PICTURE.height,
           shading: str = PICTURE.shading, samples: int | None = PICTURE.samples, quantity: str = PICTURE.quantity,
           denoise: bool | str = False, crease_angle: float = PICTURE.crease_angle, seed: int = PICTURE.seed, threads: int = 0,
           progress: ProgressArgument = None, **options: Any) -> NDArray[np.float32]:
    """Draws a view of a solution: float32 (height, width, 3), radiance [cd/m^2 or W/(m^2 sr)], row 0 at the top.

    Args:
        lit: Solution; for path tracing and instant radiosity also a Scene or the path of one.
        view: View, or its name in the scene; default: the first view of the solution, of the scene, or an overview.
        width: [pixels]
        height: [pixels]
        shading: "flat", "smooth": the light of the elements. "hybrid": direct light per pixel, indirect light interpolated.
            "gather": final gathering. "path", "instant": without the solution.
        samples: Samples per pixel; default: 16, 16, 32, 16, 64 and 64, in this order.
        quantity: "radiance", or "irradiance" [lux or W/m^2] independent of reflectance.
        denoise: Filters the noise, not for smooth and flat shading: "oidn" by Intel Open Image Denoise (of the package
            pyoidn, for example), "own" by this program's filter; "auto" or True by the first that is found.
        crease_angle: Maximum angle between faces with common smooth shading [degrees].
        seed: The same seed gives the same bits for any number of threads.
        threads: Number of threads; 0: all.
        progress: As of solve().
        options: until, max_samples, time, mirrors, light_walks, as of trace().

    Raises:
        InputError: for a view that defines no picture and an option out of range.
    """
    picture = _core.PictureOptions(width=width, height=height, shading=shading, samples=samples, quantity=quantity,
                                   crease_angle=crease_angle, seed=seed, **options)
    if not _core.traces_paths(shading):
        if options:
            raise TypeError(f"{shading} shading takes no {', '.join(options)}")
        if denoise:
            raise TypeError(f"{shading} shading has no noise to filter")
    rendering = _draw(lit, view, picture, threads, progress)
    return rendering.denoise("auto" if denoise is True else denoise) if denoise else rendering.image


def preview(lit: _core.Solution, view: ViewArgument = None, *, width: int = PICTURE.width, height: int = PICTURE.height,
            reduction: float = 4, quantity: str = PICTURE.quantity, denoiser: str = "auto", mirrors: bool = PICTURE.mirrors,
            seed: int = PICTURE.seed, threads: int = 0, progress: ProgressArgument = None) -> NDArray[np.float32]:
    """Draws a view of a solution in a fraction of the time of render(): float32 (height, width, 3), in its units.

    Light is drawn as by "hybrid" shading, with two samples a pixel, in a smaller picture, filtered and interpolated over
    the surfaces that each pixel shows. Outlines, textures and lamps are sharp; small shadows are blurred.

    Args:
        lit: Solution.
        view, width, height, quantity, seed, threads, progress: As of render().
        reduction: Light is traced for one in reduction x reduction pixels; at least 1, and need not be whole.
        denoiser: "oidn", "own", or "auto", the first that is found.
        mirrors: Whether the camera sees mirrors.

    Raises:
        InputError: for a view that defines no picture and an option out of range.
    """
    if not isinstance(lit, _core.Solution):
        raise TypeError(f"a preview needs a Solution: expected the result of solve(), found {lit!r}")
    options = _core.PictureOptions(width=width, height=height, quantity=quantity, mirrors=mirrors, seed=seed)
    if view is None and lit.views:
        view = lit.views[0].view  # for which the solution was made
    with reporting(progress, "drawing") as report:
        return _core.preview(lit, view, options, reduction, denoiser, threads, report).image


def trace(lit: LitArgument, view: ViewArgument = None, *, width: int = PICTURE.width, height: int = PICTURE.height,
          shading: str = "path", samples: int | None = PICTURE.samples, quantity: str = PICTURE.quantity,
          until: float = PICTURE.until, max_samples: int = PICTURE.max_samples, time: float = PICTURE.time,
          mirrors: bool = PICTURE.mirrors, light_walks: int = PICTURE.light_walks, seed: int = PICTURE.seed,
          threads: int = 0, progress: ProgressArgument = None) -> _core.Rendering:
    """Draws a view by paths, with its standard error and its layers: path tracing, an independent reference without a
    solution; instant radiosity; final gathering or hybrid shading of a solution.

    Args:
        lit, view, width, height, samples, quantity, seed, threads, progress: As of render().
        shading: "hybrid", "gather", "path" or "instant".
        until: Target of each pixel's relative standard error; 0: every pixel gets `samples`.
        max_samples: Maximum number of paths per pixel with a target.
        time: Maximum duration [s]; every pixel gets two batches of paths, however long they take.
        mirrors: Whether the camera sees mirrors.
        light_walks: Instant radiosity: walks from the light sources for a batch of paths.

    Returns:
        The picture, in the units of render().

    Raises:
        InputError: as render(); also for "smooth" and "flat".
    """
    if not _core.traces_paths(shading):
        raise InputError(f"shading: {shading} traces no paths; use render()")
    picture = _core.PictureOptions(width=width, height=height, shading=shading, samples=samples, quantity=quantity,
                                   until=until, max_samples=max_samples, time=time, mirrors=mirrors,
                                   light_walks=light_walks, seed=seed)
    return _draw(lit, view, picture, threads, progress)


def tonemap(image: ArrayLike, *, exposure: float | None = None, curve: str = "srgb",
            display_luminance: float = 100) -> NDArray[np.uint8]:
    """Display values of a picture: uint8 (height, width, 3), sRGB, for matplotlib and Pillow. Pixels that are not finite
    become magenta.

    Args:
        image: (height, width, 3): radiance; [cd/m^2] for the last three curves.
        exposure: [stops]; a luminance of 2^-exposure becomes 1. Default: automatic, for a natural impression of a lit room.
        curve: srgb, reinhard, filmic, agx, ward, tumblin or ferwerda (docs/light/tone-mapping.md).
        display_luminance: White of the display [cd/m^2], for the last three.

    Raises:
        InputError: for another shape, and for an unknown curve.
    """
    return _core.tonemap(np.asarray(image, np.float32), exposure, curve, display_luminance)


def probe(solution: _core.Solution, points: ArrayLike | _core.MeasuringGrid, normals: ArrayLike | None = None, *,
          receiver: str = "planar", axis: ArrayLike = (0, 0, 1), shading: str = MEASURING.shading,
          samples: int | None = MEASURING.samples, until: float = MEASURING.until, seed: int = MEASURING.seed,
          threads: int = 0, progress: ProgressArgument = None) -> _core.Measurement:
    """Measures irradiance at points, as `interflect probe`.

    Args:
        solution: Result of solve().
        points: (n, 3) world coordinates [m], or a grid of area_grid() or line_grid(). A point on a surface measures its
            irradiance.
        normals: (n, 3) or (3,); default: the grid's, or up. Need not be normalised.
        receiver: "planar", "cylindrical" or "semicylindrical" (EN 12464-1, CIE 136).
        axis: (3,) or (n, 3): axis of cylinders. Need not be normalised.
        shading: "gather" from the solution, or "path" for path tracing alone.
        samples: Directions per point, 4096 by default; with a target the minimum.
        until: Target of the relative standard error; 0: none.
        seed, threads, progress: As of render().

    Returns:
        Irradiance with its standard error, one row per point.

    Raises:
        InputError: for other shapes, and for points that are not finite.
    """
    if isinstance(points, _core.MeasuringGrid):
        normals = points.normal if normals is None else normals
        points = points.points
    normals = (0, 0, 1) if normals is None else normals
    options = _core.MeasuringOptions(shading=shading, samples=samples, until=until, seed=seed)
    with reporting(progress, "measuring") as report:
        return _core.probe(solution, points, normals, receiver, axis, options, threads, report)


def export(solution: _core.Solution, path: str | os.PathLike[str], *, lightmap: bool = False,
           exposure: float | None = None, threads: int = 0, progress: ProgressArgument = None,
           **options: Any) -> list[Path]:
    """Writes a solved scene for other programs, in the format of the extension of `path` (docs/files/export.md).

    Args:
        solution: Result of solve().
        path: .glb, .gltf, .ply, .obj, .vtkhdf, .hdf or .vtu; .json or .exr for probes.
        lightmap: Stores the light in lightmaps rather than in vertices.
        exposure: [stops], of 8-bit colours. None: automatic for the first view or, without a view, the lit surfaces.
        threads, progress: As of render().
        options: up, shading (smooth, hybrid, gather), samples, seed. In vertices: max_error, min_edge, max_edge,
            max_triangles, and for .ply and .obj polygons. In lightmaps: texels_per_metre, densities (a
            dictionary of patterns of names and their texels per metre), max_size, gutter, image, own_charts, keep_file,
            keep_lights, groups, content (irradiance, radiance, density), denoise (as of render(); default: "own"), update
            (a list of patterns of names whose light is computed anew in the file; without exposure). For probes: spacing,
            rays.

    Returns:
        The files that were written. Features that the format lacks are reported by warnings.warn().

    Raises:
        InputError: for an unknown extension, options out of range and a file that cannot be updated.
        TypeError: for an unknown option.
    """
    if options.get("update"):
        if exposure is not None:
            raise InputError("exposure: an update keeps the exposure of its file")
    elif exposure is None and Path(path).suffix in COLOUR_FORMATS:
        exposure = _core.export_exposure(solution, threads)
    with reporting(progress, "exporting") as report:
        return _core.export_solution(solution, path, lightmap=lightmap, exposure=exposure or 0, threads=threads,
                                     progress=report, **options)


def rate_glare(solution: _core.Solution, eyes: ArrayLike, lines_of_sight: ArrayLike, *,
               samples: int | None = MEASURING.samples, seed: int = MEASURING.seed, threads: int = 0, progress: ProgressArgument = None) -> list[_core.GlareRating]:
    with reporting(progress, "rating glare") as report:
        return _core.rate_glare(solution, eyes, lines_of_sight, samples=samples, seed=seed, threads=threads,
                                progress=report)


rate_glare.__doc__ = _core.rate_glare.__doc__


def _repr_png(self: _core.Solution) -> bytes:
    """Small picture for notebooks."""
    return _core.png(render(self, width=480, height=270, shading="smooth", samples=4, progress=False))


setattr(_core.Solution, "_repr_png_", _repr_png)

"""Compares gathered pictures with path-traced ones, scene by scene: `experiments/run agreement`.

Rays and samples grow together. The error must fall with both, and the mean must stay. Existing rows of
results/agreement.csv are not measured again. Pairs of pictures, gathered with default options, go to docs/pictures.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np
from lab import program, results
from lab.analysis import drawing
from lab.analysis.picture import luminance, read_exr
from lab.reference import Reference
from PIL import Image

WORK = program.ROOT / "out/experiments/cache/agreement"
TABLE = program.ROOT / "experiments/results/agreement.csv"
PICTURES = program.ROOT / "docs/pictures"
SIZE = "--size 640x360"
SCENES = {
    "office": "scenes/office.mgf --view desk",
    "meeting": "scenes/office.mgf --view meeting",
    "maze": "maze:9:furniture --view room-4",
    "lights": "scenes/lights.mgf --eye 5,-4,2.5 --look-at 0,0,0.5",
    "office-graz": f"{program.SCENES}/office-graz.mgf --eye 3.7037,0.0788,2.2690 --look-at 1.0023,8.9229,-1.1130",
    "office2": f"{program.SCENES}/office2.mgf --eye 1.590,5.317,1.922 --look-at 4.11,-3.7,0.7",
    "corridor": f"{program.SCENES}/corridor.mgf --eye -3.66,-5.52,7.2 --look-at 0.2,3.47,5.11",
    "cube": f"{program.SCENES}/cube.mgf --eye 4.9,0.3,6 --look-at 4.9,9,3.5 --fov 75",
}
SIDE_BY_SIDE = ["office", "maze", "office-graz", "office2", "corridor"]
REFERENCE_PATHS = 128  # per picture; the reference has two
WORKS = [(250_000, 4), (1_000_000, 8), (4_000_000, 16), (16_000_000, 32)]  # rays to solve with, samples
MORE_WORKS = {"corridor": [(64_000_000, 32)]}  # needs a finer mesh for its mean
TARGET_MEAN = 0.005


def measure() -> None:
    command = program.find_program()
    rows = results.read_csv(TABLE) if TABLE.is_file() else []
    done = {(row["scene"], row["rays"]) for row in rows}
    for name, scene in SCENES.items():
        scene_and_view = f"{scene} {SIZE}"
        missing = [work for work in WORKS + MORE_WORKS.get(name, []) if (name, work[0]) not in done]
        if not missing and (name not in SIDE_BY_SIDE or picture_of(name).is_file()):
            continue
        reference = Reference(command, WORK, f"{name}-", scene_and_view, REFERENCE_PATHS)
        for rays, samples in missing:
            print(f"{name}: {rays} rays, {samples} samples", file=sys.stderr, flush=True)
            picture = gathered(command, scene_and_view, f"--no-mirrors --samples {samples} --rays {rays}")
            found = luminance(picture)
            rows.append(
                {
                    "scene": name,
                    "rays": rays,
                    "samples": samples,
                    "relative_rmse": round(reference.relative_rmse(found), 5),
                    "ratio_of_means": round(reference.ratio_of_means(found), 5),
                    "error_of_mean": round(reference.error_of_mean(), 5),
                    "version": command.version,
                }
            )
            results.write_csv(TABLE, rows, rows[-1])
        if name in SIDE_BY_SIDE:
            picture = gathered(command, scene_and_view, "--no-mirrors --rays 4M --denoise")
            put_side_by_side(picture, sum(read_exr(file) for file in reference.files) / 2, picture_of(name))


def picture_of(name: str) -> Path:
    return PICTURES / f"gathered-{name}.jpg"


def gathered(command: program.Program, scene_and_view: str, options: str) -> np.ndarray:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.exr"
        program.run(command, f"render {scene_and_view} {options} -o {path}".split())
        return read_exr(path)


def put_side_by_side(left: np.ndarray, right: np.ndarray, path: Path) -> None:
    """Shows both at one exposure, which maps the 98th percentile of luminance to white."""
    both = np.concatenate([left, np.ones((left.shape[0], 8, 3)) * np.inf, right], axis=1)
    linear = np.clip(both / np.percentile(luminance(right), 98), 0, 1)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)  # sRGB
    Image.fromarray(np.rint(255 * encoded).astype(np.uint8)).save(path, quality=drawing.JPEG_QUALITY)


def draw() -> None:
    rows = results.read_csv(TABLE)
    figure, (axes,) = drawing.panels(1, size=(5.2, 3.6))
    lines = []
    for number, name in enumerate(SCENES):
        runs = sorted((row for row in rows if row["scene"] == name), key=lambda row: row["rays"])
        axes.plot([r["rays"] for r in runs], [r["relative_rmse"] for r in runs], label=name, **drawing.style_of(number))
        for run in runs[-2:]:
            mean = f"{run['ratio_of_means'] - 1:+.2%} (± {run['error_of_mean']:.2%})"
            lines.append([name, f"{run['rays'] / 1e6:g} M", f"{run['samples']:g}", f"{run['relative_rmse']:.1%}", mean])
    drawing.logarithmic(axes, "rays of the solver (4, 8, 16 and 32 samples a pixel)", "relative RMSE a pixel")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncols=4)
    caption = f"""Gathered pictures of 640 x 360 pixels, not filtered: relative root mean square error of pixels of reflected light.
        Reference: twice {REFERENCE_PATHS} paths a pixel, whose noise does not count."""
    folder = program.ROOT / "docs/figures"
    drawing.save(figure, folder, "agreement", caption)
    results.write_table(folder / "agreement.md", ["scene", "rays", "samples", "relative RMSE", "mean"], lines)


def main(only_draw: bool) -> None:
    if not only_draw:
        measure()
    draw()

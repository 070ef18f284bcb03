"""Error of pictures against their time: `experiments/run pictures`.

Pictures of 960 x 540 pixels of several scenes: hybrid, gathered and smooth shading, path tracing, and Cycles from the
exported scene. Existing rows of results/pictures.csv are not measured again. The reference consists of two path-traced
pictures, whose noise cancels. Time is the processor time of reading, solving and drawing, divided by two processors, so
other work on the machine does not count.
"""

import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from measured import cycles
import numpy as np
from measured.audit_scenes import SCENES as AUDIT_SCENES
from lab import program, results
from lab.analysis import drawing
from lab.analysis.picture import luminance, read_exr
from lab.reference import Reference, box_mean

WORK = program.ROOT / "out/experiments/cache/pictures"
TABLE = program.ROOT / "experiments/results/pictures.csv"
SIZE = "--size 960x540"
OFFICE_VIEW = "--eye 3.7037,0.0788,2.2690 --look-at 1.0023,8.9229,-1.1130"
PATHS, GATHERED_FROM_40M = "path", "gather --rays 40M"


def house() -> str:
    """Returns a file and options for a house with a window and the sun."""
    scene = AUDIT_SCENES["sun-window"]()
    return f"{scene.write(WORK, 'sun-window', scene.text)} {scene.view()}"


def room_from_blender() -> str:
    return f"{cycles.exported('room')} --view window"


SCENES = {  # name: file or its maker, options, paths per pixel of each reference, its shading
    "office-graz": (f"{program.SCENES}/office-graz.mgf", OFFICE_VIEW, 128, PATHS),
    "office": ("scenes/office.mgf", "--view desk", 128, PATHS),
    "nine rooms": ("maze:9:furniture", "--view room-4", 128, PATHS),
    "sun-window": (house, "", 256, GATHERED_FROM_40M),  # few paths find the sunlit spot
    "sun and sky": (house, "--sky overcast:15000", 256, GATHERED_FROM_40M),
    "room from Blender": (room_from_blender, "", 128, PATHS),
}
PROCESSORS = 2
SMOOTH, HYBRID, GATHERED = ("--shading smooth", "--shading hybrid --no-mirrors --denoise", "--shading gather --no-mirrors --denoise")
WORKS = {  # series: options, rays to solve with (0 for path tracing) and samples
    "smooth": (SMOOTH, [(2_000_000, 16), (5_000_000, 16), (20_000_000, 16)]),
    "hybrid": (HYBRID, [(1_000_000, 4), (2_000_000, 8), (5_000_000, 16), (10_000_000, 32), (20_000_000, 64)]),
    "gathered": (GATHERED, [(1_000_000, 4), (4_000_000, 16), (8_000_000, 32)]),
    "path": ("--shading path --no-mirrors", [(0, 4), (0, 16), (0, 64)]),
    "Cycles": ("", [(0, 4), (0, 16), (0, 64)]),
}
BLOCK = 9
TARGET, TARGET_SECONDS = 0.05, 15


def processor_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Scene:
    def __init__(self, command: program.Program, name: str):
        file, view, paths, shading = SCENES[name]
        if callable(file):
            file = file()
        self.file, self.view = file, view
        self.reference = Reference(command, WORK, f"{name.replace(' ', '-')}-", f"{file} {view} {SIZE}", paths, shading)
        good = WORK / f"{name.replace(' ', '-')}-good.exr"
        if not good.is_file():
            program.run(command, f"render {file} {view} {SIZE} {HYBRID} --rays 40M --samples 128 -o {good}".split())
        self.scale = luminance(read_exr(good)) + 0.01 * self.reference.mean

    def errors(self, picture: np.ndarray) -> tuple[float, float]:
        """Relative RMSE of pixels and of blocks. The expected product of the differences from two independent pictures
        is the squared error without their noise."""
        counts = self.reference.counts
        first, second = ((picture - p) / self.scale * counts for p in self.reference.pictures)
        of_pixels = (first * second)[counts].mean()
        share = box_mean(counts.astype(float), BLOCK // 2)
        blocks = [(box_mean(p, BLOCK // 2) / np.maximum(share, 0.1))[share > 0.5] for p in (first, second)]
        return tuple(float(np.sqrt(max(0.0, square))) for square in (of_pixels, (blocks[0] * blocks[1]).mean()))


def draw_with_cycles(command: program.Program, scene: Scene, samples: int, folder: Path) -> Path:
    # The first view of an exported scene is drawn; a solution begins with that of its solve.
    program.run(command, f"solve {scene.file} {scene.view} --no-contact-cuts --rays 1k -o {folder}/scene.h5".split())
    options = f"{SIZE} --pixel-samples {samples} -o {folder}/scene.py"
    program.run(command, f"export {folder}/scene.h5 {options}".split())
    script = ["blender", "--background", "--python-exit-code", "1", "--python", f"{folder}/scene.py"]
    before = processor_seconds()
    subprocess.run([*script, "--", f"{folder}/cycles.exr"], capture_output=True, check=True)
    print(f"Cycles: {(processor_seconds() - before) / PROCESSORS:.1f} s", file=sys.stderr)
    return folder / "cycles.exr"


def measure() -> None:
    command = program.find_program()
    rows = results.read_csv(TABLE) if TABLE.is_file() else []
    done = {(row["scene"], row["series"], int(row["samples"]), int(row["rays"])) for row in rows}
    for name in SCENES:
        scene = None
        for series, (options, works) in WORKS.items():
            for rays, samples in works:
                if (name, series, samples, rays) in done:
                    continue
                if series == "Cycles" and not shutil.which("blender"):
                    continue
                scene = scene or Scene(command, name)
                print(f"{name}: {series}, {samples} samples, {rays} rays", file=sys.stderr, flush=True)
                with tempfile.TemporaryDirectory() as folder:
                    path = Path(folder) / "picture.exr"
                    before = processor_seconds()
                    if series == "Cycles":
                        path = draw_with_cycles(command, scene, samples, Path(folder))
                    else:
                        solving = f"--rays {rays}" if rays else ""
                        arguments = f"{scene.file} {scene.view} {SIZE} {options} --samples {samples} {solving}"
                        program.run(command, f"render {arguments} -o {path}".split())
                    seconds = (processor_seconds() - before) / PROCESSORS
                    picture = luminance(read_exr(path))
                of_pixels, of_blocks = scene.errors(picture)
                rows.append(
                    {
                        "scene": name,
                        "series": series,
                        "samples": samples,
                        "rays": rays,
                        "seconds": round(seconds, 2),
                        "pixels": round(of_pixels, 5),
                        "blocks": round(of_blocks, 5),
                        "ratio_of_means": round(scene.reference.ratio_of_means(picture), 5),
                        "error_of_mean": round(scene.reference.error_of_mean(), 5),
                        "version": command.version,
                    }
                )
                results.write_csv(TABLE, rows, rows[-1])


def draw() -> None:
    rows = results.read_csv(TABLE)
    names = [name for name in SCENES if any(row["scene"] == name for row in rows)]
    figure, panels = drawing.panels(len(names), size=(3.4, 3.6))
    lines = []
    for name, axes in zip(names, panels):
        for number, series in enumerate(WORKS):
            runs = sorted(
                (row for row in rows if row["scene"] == name and row["series"] == series), key=lambda row: row["seconds"]
            )
            axes.plot(
                [row["seconds"] for row in runs],
                [row["pixels"] for row in runs],
                label=series,
                **drawing.style_of(number),
            )
            for row in runs:
                solving = f"{row['rays'] / 1e6:g} M" if row["rays"] else ""
                errors = [f"{row['pixels']:.1%}", f"{row['blocks']:.1%}"]
                mean = f"{row['ratio_of_means'] - 1:+.2%} ± {row['error_of_mean']:.2%}"
                lines.append([name, series, solving, f"{row['samples']:g}", f"{row['seconds']:.1f}", *errors, mean])
        drawing.logarithmic(axes, "seconds on two cores", "relative RMSE a pixel")
        axes.set_title(name, fontsize=9)
        axes.axhline(TARGET, color="#999999", linewidth=0.8, linestyle="--")
        axes.axvline(TARGET_SECONDS, color="#999999", linewidth=0.8, linestyle="--")
    panels[0].legend(loc="lower left", fontsize=7)
    caption = """Pictures of 960 x 540 pixels: relative root mean square error of pixels of reflected light against the time that the
        picture takes with its solve, processor time over two. Reference: two path-traced pictures, whose noise does not
        count. Dashed lines: the target, 5% in 15 seconds."""
    folder = program.ROOT / "docs/figures"
    drawing.save(figure, folder, "pictures", caption)
    header = ["scene", "picture", "rays to solve", "samples", "seconds", "pixels", "blocks of 9", "mean"]
    results.write_table(folder / "pictures.md", header, lines)


def main(only_draw: bool) -> None:
    if not only_draw:
        measure()
    draw()

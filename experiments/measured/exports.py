"""Compares scenes exported to Blender with the path tracer here: `experiments/run exports`.

Cycles path-traces the script written by `interflect export`. The comparison therefore covers units, cameras, materials,
images and light sources. Pictures are means of many paths; blocks of 9 x 9 pixels have little noise left.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from lab import program, results
from lab.analysis.picture import read_exr

TABLE = program.ROOT / "experiments/results/exports.csv"
SIZE, SAMPLES = "--size 96x54", 1024
BLOCK = 9
SHELL = "".join(
    f"v {name} =\n\tp {2 * (k & 1)} {3 * (k >> 1 & 1)} {2.5 * (k >> 2)}\n" for k, name in enumerate("abcdefgh")
) + "m paint =\n\tc\n\t\tcxy .36 .34\n\trd .6\nf a b d c\nf e g h f\nf a c g e\nf b f h d\nf a e f b\nf c d h g\n"
BALL = "m clay =\n\trd 0.6\nv centre =\n\tp 0 0 0\n\tn 0 0 1\nring centre 0 5\nv ball =\n\tp 0 0 0.8\nsph ball 0.8\n"
IN_ROOM = '{"views": [{"name": "door", "eye": [0.3, 0.2, 1.6], "look_at": [1.2, 3, 1], "up": [0, 0, 1], "fov": 60}]}'
AT_BALL = '{"views": [{"name": "ball", "eye": [5, -4, 2.5], "look_at": [0, 0, 0.5], "up": [0, 0, 1], "fov": 45}]}'
# File and its views, or an existing scene; options for reading it.
SCENES = {
    "office": ("scenes/office.mgf", None, ""),
    "maze": ("maze:4:furniture", None, ""),
    "images": ("make-scene boxes --texture", None, ""),
    "point light": (SHELL + "v bulb =\n\tp 0.7 1.2 1.9\nlight point bulb 100\n", IN_ROOM, ""),
    "spot": (SHELL + "v bulb =\n\tp 0.9 1.6 2.3\n\tn 0.1 0.2 -1\nlight spot bulb 300 20 35\n", IN_ROOM, ""),
    "sun and grey sky": (BALL + "v sun =\n\tn 1 2 -2\nlight sky 1500\nlight directional sun 20000\n", AT_BALL, ""),
    "clear sky": (BALL, AT_BALL, "--sky clear --sun 200,35 --ground 0.2"),
}


def measure() -> None:
    command = program.find_program()
    rows = []
    for name, (scene, views, options) in SCENES.items():
        print(name, file=sys.stderr, flush=True)
        with tempfile.TemporaryDirectory() as folder:
            ours, cycles = pictures(command, Path(folder), scene, views, options.split())
        a, b = (blocks(picture.mean(axis=2)) for picture in (cycles, ours))
        rows.append(
            {
                "scene": name,
                "renderer": "Cycles",
                "ratio_of_means": round(float(cycles.mean() / ours.mean()), 5),
                "block_rmse": round(float(np.sqrt(np.mean((a - b) ** 2)) / b.mean()), 5),
                "version": command.version,
            }
        )
        results.write_csv(TABLE, rows, rows[-1])


def pictures(
    command: program.Program, folder: Path, scene: str, views: str | None, options: list[str]
) -> list[np.ndarray]:
    if views:
        (folder / "scene.mgf").write_text(scene)
        (folder / "scene.views.json").write_text(views)
        scene = str(folder / "scene.mgf")
    elif scene.startswith("make-scene"):
        program.run(command, [*scene.split(), "-o", str(folder / "scene.mgf")])
        scene = str(folder / "scene.mgf")
    files = [folder / "ours.exr", folder / "cycles.exr"]
    drawing = [*options, *SIZE.split()]
    information = json.loads(program.run(command, ["info", scene, *options, "--json"]).output)
    first = information["views"][0]["name"]
    ours = ["--view", first, "--shading", "path", "--no-mirrors", "--samples", str(SAMPLES), "-o", str(files[0])]
    program.run(command, ["render", scene, *drawing, *ours])
    exported = ["--pixel-samples", str(SAMPLES), "-o", str(folder / "scene.py")]
    program.run(command, ["export", scene, *drawing, *exported])
    script = program.blender_script(str(folder / "scene.py"), "--", str(files[1]))
    finished = subprocess.run(script, capture_output=True, text=True)
    if finished.returncode != 0 or not files[1].is_file():
        raise program.ExperimentError(f"blender failed:\n{finished.stdout[-1000:]}{finished.stderr[-1000:]}")
    return [read_exr(file) for file in files]


def blocks(picture: np.ndarray) -> np.ndarray:
    rows, columns = (side // BLOCK for side in picture.shape)
    return picture[: rows * BLOCK, : columns * BLOCK].reshape(rows, BLOCK, columns, BLOCK).mean(axis=(1, 3))


def draw() -> None:
    rows = results.read_csv(TABLE)
    lines = [[row["scene"], f"{row['ratio_of_means'] - 1:+.2%}", f"{row['block_rmse']:.2%}"] for row in rows]
    results.write_table(program.ROOT / "docs/figures/exports.md", ["scene", "mean", "blocks of 9 x 9 pixels"], lines)


def main(only_draw: bool) -> None:
    if not only_draw:
        measure()
    draw()

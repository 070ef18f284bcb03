"""Compares pictures of rooms from Blender, gathered here, with Cycles' from the same file: `experiments/run cycles`.

Needs Blender, 3.4 to 5.0. Pictures by Cycles are kept in out/experiments/cache/cycles. Existing rows of results/cycles.csv are
not measured again. Pairs of pictures, ours on the left, go to docs/pictures.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from measured.agreement import put_side_by_side
from lab import program, results
from lab.analysis.picture import luminance, read_exr
from lab.reference import box_mean

WORK = program.ROOT / "out/experiments/cache/cycles"
TABLE = program.ROOT / "experiments/results/cycles.csv"
SCRIPTS = program.ROOT / "experiments/blender"
WIDTH, HEIGHT, SAMPLES, SEEDS = 320, 180, 512, (1, 2)
ROOMS = {"room": ["window"], "textured": ["sofa"]}  # with their cameras
BLOCK_RADIUS = 4  # blocks of 9 by 9 pixels
TARGET_MEAN, TARGET_BLOCK = 0.03, 0.05


def blender(out: Path, script: str, *arguments) -> None:
    """Runs a script of this folder. The file `out` proves success: bpy 4.2 may crash when Python ends."""
    command = program.blender_script(str(SCRIPTS / script), "--", *map(str, arguments))
    done = subprocess.run(command, capture_output=True, text=True)
    if not out.is_file():
        raise program.ExperimentError(f"{script} has not made {out}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")


def exported(room: str) -> Path:
    path = WORK / f"{room}.glb"
    if not path.is_file():
        path.parent.mkdir(parents=True, exist_ok=True)
        blender(path, "furnished_room.py", path, room)
    return path


def rendered_by_cycles(room: str, camera: str) -> list[np.ndarray]:
    files = [WORK / f"{room}-{camera}-{seed}.exr" for seed in SEEDS]
    for file, seed in zip(files, SEEDS):
        if not file.is_file():
            print(f"Cycles: {file.name}", file=sys.stderr, flush=True)
            blender(file, "cycles_picture.py", exported(room), camera, WIDTH, HEIGHT, SAMPLES, seed, file)
    return [read_exr(file) for file in files]


def measure() -> None:
    command = program.find_program()
    rows = results.read_csv(TABLE) if TABLE.is_file() else []
    done = {(row["room"], row["camera"]) for row in rows}
    for room, camera in ((room, camera) for room, cameras in ROOMS.items() for camera in cameras):
        if (room, camera) in done:
            continue
        references = rendered_by_cycles(room, camera)
        ours, counts = gathered(command, f"{exported(room)} --view {camera}")
        rows.append({"room": room, "camera": camera, **differences(ours, references, counts), "version": command.version})
        results.write_csv(TABLE, rows, rows[-1])
        put_side_by_side(ours, sum(references) / 2, program.ROOT / f"docs/pictures/cycles-{room}.jpg")


def gathered(command: program.Program, scene_and_view: str) -> tuple[np.ndarray, np.ndarray]:
    """Returns the picture and the mask of compared pixels, which show a surface but no lamp."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.exr"
        options = f"--size {WIDTH}x{HEIGHT} --rays 16M --samples 64 --layers"
        program.run(command, f"render {scene_and_view} {options} -o {path}".split())
        picture, lamps = read_exr(path), luminance(read_exr(path, "emitted"))
    seen = (luminance(picture) > 0) & (lamps == 0)
    return picture, np.isclose(box_mean(seen.astype(float), 1), 1)


def differences(ours: np.ndarray, references: list[np.ndarray], counts: np.ndarray) -> dict:
    """Compares the means, and the blocks: root mean square relative to the reference, without its noise, and the
    share of blocks beyond the target."""
    found, (first, second) = luminance(ours), map(luminance, references)
    mean = (first + second) / 2
    weight = box_mean(counts.astype(float), BLOCK_RADIUS)
    whole = np.zeros_like(counts)
    whole[BLOCK_RADIUS :: 2 * BLOCK_RADIUS + 1, BLOCK_RADIUS :: 2 * BLOCK_RADIUS + 1] = True
    chosen = whole & (weight > 0.5)
    blocks = [(box_mean(p * counts, BLOCK_RADIUS) / np.maximum(weight, 0.1))[chosen] for p in (found, first, second)]
    relative = [(blocks[0] - block) / ((blocks[1] + blocks[2]) / 2) for block in blocks[1:]]
    return {
        "ratio_of_means": round(float(found[counts].mean() / mean[counts].mean()), 5),
        "channels": "/".join(f"{c:.4f}" for c in ours[counts].mean(0) / (sum(references) / 2)[counts].mean(0)),
        "block_rmse": round(float(np.sqrt(max(0, (relative[0] * relative[1]).mean()))), 5),
        "blocks": int(chosen.sum()),
        "blocks_beyond": int((np.abs(relative[0] + relative[1]) / 2 > TARGET_BLOCK).sum()),
    }


def draw() -> None:
    lines = []
    for row in results.read_csv(TABLE):
        beyond = f"{row['blocks_beyond']:g} of {row['blocks']:g}"
        lines.append([row["room"], row["camera"], f"{row['ratio_of_means'] - 1:+.2%}", f"{row['block_rmse']:.2%}", beyond])
    header = ["room", "camera", "mean", "RMS of blocks", f"blocks beyond {TARGET_BLOCK:.0%}"]
    results.write_table(program.ROOT / "docs/figures/cycles.md", header, lines)


def main(only_draw: bool) -> None:
    if not only_draw:
        measure()
    draw()

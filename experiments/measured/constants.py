"""Halves and doubles the numbers in the solver that were chosen by measurement: `experiments/run constants`.

A copy of the sources is built in which each of these constants is multiplied by a factor from the environment. Three
scenes, which served no other measurement, are then solved with every constant halved and doubled. The table has the
squared error of the picture and the number of elements, both over those with the constants as they are.
"""

import hashlib
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from measured.audit import Reference, Scale
from measured.audit_scenes import Mgf, Scene
from lab import program, results
from lab.analysis.picture import luminance, read_exr

WORK = program.ROOT / "out/experiments/cache/constants"
TABLE = program.ROOT / "experiments/results/constants.csv"
PAGE = program.ROOT / "docs/figures/constants.md"
RAYS, SEEDS, BASE_SEEDS = 3_000_000, 3, 12
FACTORS = (0.5, 2.0)
SCALE = Scale(rays=RAYS, size=(320, 180))

# By file of src/interflect/solver, the constants that are measurements. Others are derived beside their definition
# (headroom of fixed-point sums, rounding, sizes of batches, which change no result).
CONSTANTS = {
    "methods/bounce_budget.cpp": "fewest_rays_of_bounce min_share_left fewest_walks assumed_bounces decay_at_first",
    "methods/importance_transport.cpp": "negligible_importance",
    "importance/importance_weights.cpp": "taken_over rays_of_mean",
    "sampling/ray_plan.cpp": "share_of_nearby",
    "state/solver_state.cpp": "rays_per_camera_ray",
    "state/element_floor.cpp": "min_cosine",
    "state/schedule.cpp": "growth first_rays_per_patch fewest_first_rays budget_over_first_rays rays_of_a_moment",
    "noise/noise_model.cpp": "spread_decay largest_scale contributions_of_half_weight",
    "error/error_estimate.cpp": "min_decay max_decay",
    "shrinkage/sibling_variation.cpp": "under_sampled highest_expected_decay",
    "shrinkage/sibling_variation.h": "assumed_variation",
    "error/noise_update.cpp": "long_enough",
    "refinement/oracle_threshold.cpp": "rays_at_epsilon",
    "refinement/variance_refinement.cpp": "expected_decay assumed_square min_signal negligible_gain negligible_misplacement "
    "tolerable_misplacement invisible_error_weight",
    "iteration/outdoor_targets.cpp": "enough max_lines fewest_lines share_of_rest worthwhile_share widest_target rays_of_lines "
    "max_rays all_over_rays",
}
TUNED = '''#pragma once

#include <cstdlib>
#include <cstring>

namespace interflect::detail {

/// Returns the value, times the factor in INTERFLECT_CONSTANT ("name=factor") if it has this name.
template <class T>
T tuned(const char* name, T value) {
    const char* asked = std::getenv("INTERFLECT_CONSTANT");
    const std::size_t length = std::strlen(name);
    if (!asked || std::strncmp(asked, name, length) != 0 || asked[length] != '=') return value;
    return static_cast<T>(static_cast<double>(value) * std::atof(asked + length + 1));
}

}  // namespace interflect::detail
'''


def gallery() -> Scene:
    """A long gallery with pillars, lit by wall washers behind a parapet, seen along its axis."""
    mgf = Mgf()
    mgf.room((5.2, 17.5, 3.7))
    mgf.lamp("washer", 9000)
    for i in range(4):
        mgf.fixture("washer", (0.12, 1.3 + 4.1 * i, 2.35), (0.2, 2.2, 0.1), shines="+z")
        mgf.box("white", (3.6, 2.6 + 3.9 * i, 0), (0.55, 0.45, 3.7), turn=17 * i)
    mgf.box("blue", (1.4, 9.1, 0), (1.1, 2.3, 0.8), turn=31)
    return Scene(mgf.text(), eye=(1.1, 0.5, 1.6), look_at=(3.1, 14, 1.3), fov=52)


def attic() -> Scene:
    """A dark room with a sloping roof and one dormer that lets in a sky and the sun; crates on the floor."""
    mgf = Mgf()
    mgf.material("white", "rd 0.58", sides=2)
    mgf.material("grey", "rd 0.22", sides=2)
    mgf.material("wood", "rd 0.31", sides=2, colour=(0.41, 0.39))
    mgf.quad("wood", (0, 0, 0), (6.3, 0, 0), (0, 7.9, 0))
    mgf.quad("white", (0, 0, 0), (0, 0, 3.4), (6.3, 0, 0))
    mgf.quad("white", (0, 7.9, 0), (6.3, 0, 0), (0, 0, 3.4))
    mgf.quad("white", (0, 0, 0), (0, 7.9, 0), (0, 0, 3.4))
    mgf.wall_with_hole("white", (6.3, 7.9, 0), (0, -7.9, 0), (0, 0, 1.2), (0.30, 0.35, 0.47, 0.95))
    mgf.quad("grey", (0, 7.9, 3.4), (0, -7.9, 0), (6.3, 0, -2.2))
    mgf.face("white", (0, 0, 3.4), (6.3, 0, 1.2), (6.3, 0, 3.4))  # behind the roof
    for i in range(7):
        mgf.box("wood", (0.5 + 0.73 * i, 1.1 + 0.9 * ((3 * i) % 7), 0), (0.5, 0.4 + 0.05 * i, 0.3 + 0.09 * i), turn=23 * i)
    return Scene(mgf.text(), eye=(0.7, 7.2, 1.5), look_at=(4.9, 2.0, 0.4), fov=66, options="--sun 100,34 --sky clear")


def stairwell() -> Scene:
    """Two rooms joined by a doorway; the view shows one, the lamps are in the other."""
    mgf = Mgf()
    mgf.room((9.4, 4.1, 2.9))
    mgf.lamp("tube", 16000)
    for low, size in (((4.9, 0, 0), (0.1, 0.74, 2.9)), ((4.9, 1.72, 0), (0.1, 2.38, 2.9)), ((4.9, 0.74, 2.15), (0.1, 0.98, 0.75))):
        mgf.box("white", low, size)
    mgf.fixture("tube", (6.4, 1.1, 2.75), (1.5, 0.12, 0.1), ceiling=2.9)
    mgf.fixture("tube", (7.9, 2.7, 2.75), (0.12, 1.0, 0.1), ceiling=2.9)
    for step in range(6):
        mgf.box("grey", (0.1 + 0.28 * step, 2.7, 0), (0.28, 1.3, 0.17 * (step + 1)))
    mgf.box("red", (3.1, 0.3, 0), (0.6, 0.9, 1.1), turn=12)
    return Scene(mgf.text(), eye=(4.4, 3.6, 1.7), look_at=(0.6, 1.0, 0.7), fov=64)


SCENES = {"gallery": gallery, "attic": attic, "stairwell": stairwell}


def instrumented() -> Path:
    """Builds the command with constants from the environment. @return its path."""
    source, build = WORK / "source", WORK / "build"
    shutil.rmtree(source, ignore_errors=True)
    for folder in ("src", "include", "apps", "cmake"):
        shutil.copytree(program.ROOT / folder, source / folder)
    for file in ("CMakeLists.txt", "LICENSE"):
        shutil.copy2(program.ROOT / file, source / file)
    solver = source / "src/interflect/solver"
    (source / "src/interflect/base/tuned.h").write_text(TUNED)
    for file, names in CONSTANTS.items():
        path = solver / file
        text = path.read_text()
        for name in names.split():
            text = replaced(text, name, file)
        first = text.index("#include")
        path.write_text(text[:first] + '#include "interflect/base/tuned.h"\n' + text[first:])
    options = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DINTERFLECT_UNITY=ON", "-DINTERFLECT_TESTS=OFF"]
    subprocess.run(["cmake", "-S", source, "-B", build, *options], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", build, "--target", "interflect_command"], check=True)
    return next(build.rglob("bin/interflect"))


def replaced(text: str, name: str, file: str) -> str:
    """Makes `constexpr T ..., name = value, ...;` read the factor of this constant."""
    statement = re.search(rf"^\s*(inline )?(?:constexpr|const) ([\w:]+) ([^;{{}}]*?\b{name} = [^;]*);", text, re.MULTILINE)
    if not statement:
        raise program.ExperimentError(f"src/interflect/solver/{file} has no constant '{name}'")
    kind, definition = statement.group(2), statement.group(3)
    value = re.search(rf"\b{name} = ((?:[^,()]|\([^()]*\))*)", definition).group(1)
    changed = definition.replace(f"{name} = {value}", f'{name} = tuned<{kind}>("{name}", {value})')
    return text.replace(statement.group(0), f"\n{statement.group(1) or ''}const {kind} {changed};", 1)


@dataclass(frozen=True)
class Run:
    scene: str
    constant: str  # "" for the constants as they are
    factor: float
    seed: int


@dataclass(frozen=True)
class Bench:
    command: program.Program

    def references(self) -> dict[str, tuple[Scene, Path, Reference]]:
        found = {}
        for name, make in SCENES.items():
            scene = make()
            scene.samples = 256
            found[name] = (scene, scene.write(WORK / "scenes", name, scene.text), Reference(self.command, name, scene, SCALE, WORK))
        return found

    def measure(self, run: Run, scene: Scene, path: Path, reference: Reference) -> dict:
        os.environ["INTERFLECT_CONSTANT"] = f"{run.constant}={run.factor}"
        with tempfile.TemporaryDirectory() as folder:
            picture, stats = Path(folder) / "picture.exr", Path(folder) / "stats"
            options = f"{scene.view()} {scene.options} --size {SCALE.size[0]}x{SCALE.size[1]} --rays {RAYS} --seed {run.seed}"
            render = f"--shading smooth -o {picture} --stats {stats}"
            program.run(self.command, ["render", str(path), *options.split(), *render.split()])
            values = luminance(read_exr(picture))
            last = program.read_stats(stats)[1]
        error = reference.pixel_error(values, values)[0]
        return {
            "scene": run.scene, "constant": run.constant, "factor": run.factor, "seed": run.seed, "error": error,
            "mean": reference.mean_ratio(values), "elements": last["elements"], "seconds": last["seconds"],
        }


def runs() -> list[Run]:
    seeds = range(1, SEEDS + 1)
    names = [name for names in CONSTANTS.values() for name in names.split()]
    base = [Run(scene, "", 1.0, seed) for scene in SCENES for seed in range(1, BASE_SEEDS + 1)]
    return base + [Run(scene, name, factor, seed) for name in names for scene in SCENES for factor in FACTORS for seed in seeds]


TEXTS = {"scene", "constant", "build"}


def measure_all() -> None:
    path = instrumented()
    os.environ["INTERFLECT_COMMAND"] = str(path)
    command = program.find_program()
    sources = b"".join(p.read_bytes() for p in sorted((WORK / "source/src").rglob("*")) if p.is_file())
    build = hashlib.sha256(sources).hexdigest()[:12]
    rows = [row for row in (results.read_csv(TABLE, TEXTS) if TABLE.is_file() else []) if row["build"] == build]
    known = {(row["scene"], row["constant"], row["factor"], int(row["seed"])) for row in rows}
    bench = Bench(command)
    references = bench.references()
    todo = [run for run in runs() if (run.scene, run.constant, run.factor, run.seed) not in known]
    for i, run in enumerate(todo):
        if sys.stderr.isatty():
            print(f"\r{i + 1} of {len(todo)}: {run.scene}, {run.constant} x {run.factor:g}        ", end="", file=sys.stderr, flush=True)
        rows.append(bench.measure(run, *references[run.scene]) | {"build": build})
        if i % 20 == 0 or i + 1 == len(todo):
            results.write_csv(TABLE, rows, list(rows[0]))


def write_page() -> None:
    rows = results.read_csv(TABLE, TEXTS)
    log = lambda quantity, row: math.log(max(row[quantity], 1e-12)) * (2 if quantity == "error" else 1)
    base = {
        (scene, quantity): [log(quantity, row) for row in rows if row["scene"] == scene and not row["constant"]]
        for scene in SCENES
        for quantity in ("error", "elements")
    }
    ratios: dict = defaultdict(list)
    for row in rows:
        if row["constant"]:
            for quantity in ("error", "elements"):
                ratios[row["constant"], row["factor"], quantity].append(log(quantity, row) - np.mean(base[row["scene"], quantity]))
    spread = np.mean([np.std(base[scene, "error"], ddof=1) for scene in SCENES])
    noise = spread / math.sqrt(len(SCENES) * SEEDS)
    lines = []
    for file, names in CONSTANTS.items():
        for name in names.split():
            cells = [f"`{name}`", f"`{file}`"]
            for factor in FACTORS:
                by = {q: math.exp(np.mean(ratios[name, factor, q])) for q in ("error", "elements")}
                strong = abs(math.log(by["error"])) > 3 * noise
                error = f"**{by['error']:.2f}**" if strong else f"{by['error']:.2f}"
                cells += [error, f"{by['elements']:.2f}"]
            lines.append(cells)
    header = ["constant", "file", *(f"{what}, {change}" for change in ("halved", "doubled") for what in ("squared error", "elements"))]
    results.write_table(PAGE, header, lines)
    print(f"standard error of a squared error in the table: {noise:.1%}; bold: more than three of them from 1")


def main(only_draw: bool) -> None:
    if not only_draw:
        measure_all()
    write_page()
    print(PAGE.read_text(), end="")

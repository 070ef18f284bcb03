"""Measures the solver against its targets: `experiments/run acceptance --rows abd`.

Each measured value is a row of results/acceptance.csv. Existing rows are not measured again, so delete the file after a
change of the solver. The table is printed and written to docs/figures/acceptance.md. References are path-traced. Their
noise, which the path tracer estimates, is subtracted from mean square errors.
"""

import csv
import json
import math
import re
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

import numpy as np
from lab import program, results
from lab.analysis.picture import luminance, read_exr
from lab.analysis.statistics import crossing

WORK = program.ROOT / "out/experiments/cache/acceptance"
TABLE = program.ROOT / "experiments/results/acceptance.csv"
COLUMNS = ["row", "case", "seed", "quantity", "value", "command", "version"]
OFFICE_VIEW = "--eye 3.7037,0.0788,2.2690 --look-at 1.0023,8.9229,-1.1130"
SCENES = program.SCENES
CYCLES = f"{SCENES}/reference/office-graz.cycles4096.240x135.hdr"


class Bench:
    """Runs the program and stores values in TABLE."""

    def __init__(self):
        WORK.mkdir(parents=True, exist_ok=True)
        self._temporary = tempfile.TemporaryDirectory()
        self._folder = Path(self._temporary.name)
        self.program = program.find_program()
        self.rows = list(csv.DictReader(TABLE.open())) if TABLE.is_file() else []
        if not self.rows:
            TABLE.write_text(",".join(COLUMNS) + "\n")

    def measure(self, row: str, case: str, seed: int, command: str, found) -> None:
        """Stores the named values returned by found(), unless the table contains them."""
        if any((r["row"], r["case"], r["seed"]) == (row, case, str(seed)) for r in self.rows):
            return
        print(f"{row}: {case}, seed {seed}", file=sys.stderr, flush=True)
        command = command.replace(f"{program.ROOT}/", "")
        for quantity, value in found().items():
            values = [row, case, str(seed), quantity, f"{value:.6g}", command, self.program.version]
            self.rows.append(dict(zip(COLUMNS, values)))
            with TABLE.open("a", newline="") as file:
                csv.DictWriter(file, COLUMNS, lineterminator="\n").writerow(self.rows[-1])

    def values(self, row: str, quantity: str) -> dict[str, list[float]]:
        found = defaultdict(list)
        for r in self.rows:
            if (r["row"], r["quantity"]) == (row, quantity):
                found[r["case"]].append(float(r["value"]))
        return found

    def run(self, arguments: str) -> str:
        return program.run(self.program, arguments.split()).output

    def solve(self, scene: str, options: str) -> dict:
        """Solves, for picture() to draw. Returns the last iteration's statistics."""
        self.run(f"solve {scene} {options} -o {self._folder}/solved.h5 --stats {self._folder}/stats")
        header, last = program.read_stats(self._folder / "stats")
        return last | {"emitted_power": header["emitted_power"]}

    def picture(self, view: str, options: str) -> Path:
        path = self._folder / "picture.exr"
        self.run(f"render {self._folder}/solved.h5 {view} {options} -o {path}")
        return path

    def reference(self, scene: str, view: str, size: str, paths: int) -> tuple[Path, np.ndarray]:
        """Returns a path-traced picture and the standard error of its luminance, cached in WORK."""
        name = re.sub(r"\W+", "-", f"{Path(scene).name} {view} {size} {paths}")
        path, error = WORK / f"{name}.exr", WORK / f"{name}-error.exr"
        if not error.is_file():
            options = f"--shading path --no-mirrors --size {size} --samples {paths} --seed 99"
            self.run(f"render {scene} {view} {options} -o {path} --error-image {error}")
        return path, luminance(read_exr(error))  # the channels are correlated: most light is nearly white

    def compare(self, picture: Path, reference: Path) -> dict:
        return json.loads(self.run(f"compare {picture} {reference} --json"))

    def relative_mse(self, picture: Path, reference: Path, noise: np.ndarray) -> float:
        """Returns the value from `compare`, less the contribution of the reference's noise."""
        wanted = luminance(read_exr(reference))
        floor = np.mean(noise**2 / (wanted**2 + (0.01 * wanted.mean()) ** 2))
        return self.compare(picture, reference)["relative_mse"] - float(floor)


def share_emitted(stats: dict) -> float:
    return sum(stats["total_power"]) / sum(stats["emitted_power"])


def measure_a(bench: Bench) -> None:
    scenes = [f"{SCENES}/{name}.mgf" for name in ("cube", "office2", "corridor", "floor_gloss", "office-graz")]
    for scene in [*scenes, "scenes/office.mgf", "maze:9:furniture"]:
        for rays, seeds in (("2M", (1, 2, 3)), ("50M", (9,))):
            for seed in seeds:
                options = f"--method hsrr --rays {rays} --seed {seed}"
                found = lambda: {"total over emitted": share_emitted(bench.solve(scene, options))}
                bench.measure("a", f"{Path(scene).stem} {rays}", seed, f"solve {scene} {options}", found)


def table_a(bench: Bench):
    ratios = bench.values("a", "total over emitted")
    for case in (case for case in ratios if case.endswith(" 2M")):
        if far := ratios.get(case.replace(" 2M", " 50M")):
            few = ratios[case]
            yield f"total power, hsrr, 2 M rays over 50 M: {case[:-3]}", "± 0.5%", difference(few, far[0]), len(few)


def difference(values: list[float], reference: float = 1.0) -> str:
    """Formats the mean and, for several values, the standard deviation."""
    ratio = np.array(values) / reference - 1
    return f"{ratio.mean():+.2%}" + (f" (± {ratio.std(ddof=1):.2%})" if len(ratio) > 1 else "")


def measure_b(bench: Bench) -> None:
    scene, size = f"{SCENES}/office-graz.mgf", "240x135"
    reference, _ = bench.reference(scene, OFFICE_VIEW, size, 256)
    cycles = Path(program.expanded(CYCLES))
    found = lambda: {"ratio to Cycles": bench.compare(reference, cycles)["ratio_of_means"]}
    bench.measure("b", "path tracer", 99, f"render {scene} {OFFICE_VIEW} --shading path", found)
    for rays, seeds in (("5M", (1, 2, 3)), ("50M", (1,))):
        for seed in seeds:
            options = f"{OFFICE_VIEW} --method ihsrr --rays {rays} --seed {seed}"

            def ratios():
                bench.solve(scene, options)
                picture = bench.picture(OFFICE_VIEW, f"--size {size} --shading smooth")
                return {
                    "ratio to Cycles": bench.compare(picture, cycles)["ratio_of_means"],
                    "ratio to path tracer": bench.compare(picture, reference)["ratio_of_means"],
                }

            bench.measure("b", rays, seed, f"solve {scene} {options}", ratios)


def table_b(bench: Bench):
    for case, values in bench.values("b", "ratio to path tracer").items():
        yield f"office-graz, {case} rays, mean over the path tracer's", "0%", difference(values), len(values)
    for case, values in bench.values("b", "ratio to Cycles").items():
        figure = f"{np.mean(values):.1f}"
        yield f"office-graz, {case}{' rays' if case != 'path tracer' else ''}, ratio to Cycles", "179", figure, len(values)


def is_near_lamp(reference: np.ndarray) -> np.ndarray:
    """Returns the mask of pixels in which a lamp covers at least a twentieth, and their neighbours."""
    bright = reference > max(0.05 * reference.max(), 8 * np.median(reference))
    return widest(bright)


def widest(values: np.ndarray) -> np.ndarray:
    """Computes the maximum over the 3 x 3 pixels around each pixel."""
    padded = np.pad(values, 1, mode="edge")
    height, width = values.shape
    return np.max([padded[y : y + height, x : x + width] for y in range(3) for x in range(3)], axis=0)


HONEST = [
    ("two-rooms lit, lamp out", "two-rooms", "--eye 0.3,0.3,1.6 --look-at 2.3,2.3,1.2 --fov 45"),
    ("two-rooms lit, lamp in", "two-rooms", "--eye 0.3,0.3,1.6 --look-at 2.3,2.3,1.9 --fov 45"),
    ("maze:9:furniture room-4", "maze:9:furniture", "--view room-4"),
    ("office desk", "scenes/office.mgf", "--view desk"),
    ("office meeting", "scenes/office.mgf", "--view meeting"),
]


def made(bench: Bench, options: str) -> str:
    """Returns a scene generated by `make-scene`, cached; two-rooms by default."""
    path = WORK / f"{re.sub(r'[^a-z0-9]+', '-', options)}.mgf"
    if not path.is_file():
        bench.run(f"make-scene {options} -o {path}")
    return str(path)


def measure_c(bench: Bench) -> None:
    for request in ("10%", "5%", "3%"):
        for name, scene, view in HONEST:
            if scene == "two-rooms":
                scene = made(bench, scene)
            reference, noise = bench.reference(scene, view, "1280x720", 16)  # size assumed by the solver's estimate
            wanted = luminance(read_exr(reference))
            kept = ~is_near_lamp(wanted)
            for seed in (1, 2):
                options = f"{view} --until {request} --rays 100M --seed {seed}"

                def errors():
                    stats = bench.solve(scene, options)
                    picture = luminance(read_exr(bench.picture(view, "--size 1280x720 --shading flat --samples 4")))
                    square = np.mean((picture - wanted)[kept] ** 2 - noise[kept] ** 2)
                    true = math.sqrt(max(square, 0.0)) / wanted[kept].mean()
                    return {
                        "estimated": stats["error_estimate"],
                        "noise estimate": stats["noise_estimate"],
                        "mesh estimate": stats["discretisation_estimate"],
                        "true": true,
                        "ratio of means": picture[kept].mean() / wanted[kept].mean(),
                        "reference noise": math.sqrt(np.mean(noise[kept] ** 2)) / wanted[kept].mean(),
                        "rays": stats["rays"],
                        "masked": 1 - kept.mean(),
                    }

                bench.measure("c", f"{name}, --until {request}", seed, f"solve {scene} {options}", errors)


def table_c(bench: Bench):
    true = bench.values("c", "true")
    for case, estimated in bench.values("c", "estimated").items():
        ratio = np.mean(estimated) / np.sqrt(np.mean(np.square(true[case])))
        figure = f"{ratio:.2f} ({np.mean(estimated):.1%} / {np.mean(true[case]):.1%})"
        yield f"estimated over true error: {case}", "0.8 to 1.25", figure, len(estimated)


TURNED = [  # room, camera, target with the lamp out of frame, target with it in frame
    ("two-rooms", "0.3,0.3,1.6", "2.3,2.3,1.45", "2.3,2.3,1.65", "--fov 45"),
    ("two-rooms --furniture", "0.3,0.3,1.6", "2.3,2.3,1.45", "2.3,2.3,1.65", "--fov 45"),
]


def measure_d(bench: Bench) -> None:
    for room, eye, *targets, fov in TURNED:
        scene = made(bench, room)
        for place, target in zip(("out", "in"), targets):
            for seed in (1, 2, 3):
                options = f"--eye {eye} --look-at {target} {fov} --rays 5M --seed {seed}"

                def elements():
                    stats = bench.solve(scene, options)
                    picture = bench.picture(f"--eye {eye} --look-at {target} {fov}", "--size 160x90 --shading flat")
                    return {"elements": stats["elements"], "brightest pixel": luminance(read_exr(picture)).max()}

                bench.measure("d", f"{room}, lamp {place}", seed, f"solve {scene} {options}", elements)


def table_d(bench: Bench):
    elements = bench.values("d", "elements")
    for case in (case for case in elements if case.endswith(" in")):
        inside, outside = np.mean(elements[case]), np.mean(elements[case.replace(" in", " out")])
        figure = f"{inside / outside - 1:+.1%} ({inside:,.0f}, {outside:,.0f})"
        yield f"elements with the lamp in frame over out of it: {case.split(',')[0]}", "± 5%", figure, len(elements[case])


def measure_e(bench: Bench) -> None:
    for room in ("two-rooms", "two-rooms --turn 30", "two-rooms --furniture", "two-rooms --turn 30 --furniture"):
        scene = made(bench, room)
        for seed in (1, 2, 3):
            options = f"--method hsrr --rays 1M --seed {seed}"

            def leak():
                bench.solve(scene, options)
                means = []
                for view in ("dark", "lit"):
                    picture = luminance(read_exr(bench.picture(f"--view {view}", "--size 320x180 --shading flat")))
                    means.append(np.mean(picture, where=~is_near_lamp(picture) if view == "lit" else True))
                return {"dark over lit": means[0] / means[1]}

            bench.measure("e", room, seed, f"solve {scene} {options}", leak)


def table_e(bench: Bench):
    for room, values in bench.values("e", "dark over lit").items():
        yield f"dark over lit room, hsrr, 1 M rays: {room}", "0.1%", f"{np.mean(values):.4%}", len(values)


def measure_g(bench: Bench) -> None:
    scene, view = "maze:9:furniture", "--view room-4"
    reference, noise = bench.reference(scene, view, "320x180", 256)
    for rays, seeds in (("4500k", (1, 2, 3)), ("20M", (1, 2, 3))):
        for seed in seeds:
            options = f"{view} --method ihsrr --rays {rays} --seed {seed}"

            def errors():
                bench.solve(scene, options)
                picture = bench.picture(view, "--size 320x180 --samples 64 --shading smooth")
                return {"relative MSE": bench.relative_mse(picture, reference, noise)}

            bench.measure("g", rays, seed, f"solve {scene} {options}", errors)


def table_g(bench: Bench):
    for rays, values in bench.values("g", "relative MSE").items():
        target = {"4500k": 0.0261, "20M": 0.0131}[rays] / 2
        yield f"relative MSE, maze:9:furniture room-4, smooth, {rays} rays", f"{target:.4f}", f"{np.mean(values):.4f}", len(values)


def with_tiny_lamps(source: Path, target: Path) -> None:
    """Shrinks lamps to a hundredth of the area, with a hundred times the exitance, and duplicates every tenth face."""
    lines, points, lamp_vertices, material, faces = [], {}, set(), "", 0
    for line in source.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertex = words[1]
        elif words[:1] == ["p"]:
            points[vertex] = (len(lines), np.array(words[1:], dtype=float))
        elif words[:1] == ["m"]:
            material = words[1]
        elif words[:1] == ["ed"]:
            line = f"\ted {100 * float(words[1]):g}"
        elif words[:1] == ["f"]:
            if material.startswith("lamp"):
                lamp_vertices.add(tuple(words[1:]))
            faces += 1
            if faces % 10 == 0:
                lines.append(line)
        lines.append(line)
    # A lamp shares its vertices with its housing, so the housing shrinks to a pyramid closed by the lamp.
    for names in lamp_vertices:
        centre = sum(points[name][1] for name in names) / len(names)
        for name in names:
            number, point = points[name]
            lines[number] = "\tp " + " ".join(f"{x:.7f}" for x in centre + (point - centre) / 10)
    target.write_text("\n".join(lines) + "\n")


def measure_h(bench: Bench) -> None:
    plain, scene = Path(made(bench, "maze --rooms 16 --furniture")), WORK / "tiny-lamps.mgf"
    with_tiny_lamps(plain, scene)
    scene.with_suffix(".views.json").write_text(plain.with_suffix(".views.json").read_text())
    view, size = "--view room-5", "480x270"
    reference, _ = bench.reference(str(scene), view, size, 32)
    bound = 2 * widest(luminance(read_exr(reference)))
    for method in ("ihsrr", "hsrr"):
        for seed in (1, 2, 3):
            options = f"{view} --method {method} --rays 20M --seed {seed}"

            def fireflies():
                bench.solve(str(scene), options)
                found = luminance(read_exr(bench.picture(view, f"--size {size} --shading flat")))
                return {"share of fireflies": np.mean(found > bound), "worst": np.max(found / np.maximum(bound / 2, 1e-9))}

            bench.measure("h", method, seed, f"solve {scene.name} {options}", fireflies)


def table_h(bench: Bench):
    worst = bench.values("h", "worst")
    for method, values in bench.values("h", "share of fireflies").items():
        figure = f"{np.mean(values):.1e} (brightest {max(worst[method]):.2g} times the local maximum)"
        yield f"fireflies, 16 rooms with tiny lamps, {method}, 20 M rays", "< 1e-5" if method == "ihsrr" else "-", figure, len(values)


LARGEST_WORLD, CENTRE = 256, 55  # rooms, 16 in a row; the room of the view
WITHIN = {1: 9, 2: 25, 4: 72, 16: 256}  # distance from it in rooms, in either direction: number of rooms


def cut_world(source: Path, target: Path, within: int) -> None:
    """Keeps only the rooms near CENTRE, so that worlds of any size have the same room and doors in the middle."""
    rooms_in_row = math.isqrt(LARGEST_WORLD)
    kept, lines = True, []
    for line in source.read_text().splitlines(keepends=True):
        words = line.split()
        if words[:1] == ["o"] and words[1:] and words[1].startswith("room-"):
            row, column = divmod(int(words[1].removeprefix("room-")), rooms_in_row)
            kept = max(abs(row - CENTRE // rooms_in_row), abs(column - CENTRE % rooms_in_row)) <= within
        if kept or words[:1] != ["f"]:
            lines.append(line)
    target.write_text("".join(lines))


COMPARED = {1: "room-0", 16: "room-5", 64: "room-27"}  # worlds in which both methods are measured
LADDERS = {  # million rays, by number of rooms
    "ihsrr": {rooms: (0.5, 1, 2, 4) for rooms in COMPARED},
    "hsrr": {1: (0.5, 1, 2, 4), 16: (4, 16, 48), 64: (32, 96, 192)},
}
SAME_ERROR = 0.003  # relative MSE, flat, away from lamps


def measure_f(bench: Bench) -> None:
    for furniture in ("", " --furniture"):
        whole = Path(made(bench, f"maze --rooms {LARGEST_WORLD}{furniture}"))
        for within, rooms in WITHIN.items():
            scene = WORK / f"{whole.stem}-within-{within}.mgf"
            cut_world(whole, scene, within)
            scene.with_suffix(".views.json").write_text(whole.with_suffix(".views.json").read_text())
            ladder = (1, 2, 4) if not furniture else (2, 8)
            case = f"{rooms} rooms{furniture}"
            measure_errors(bench, case, str(scene), f"room-{CENTRE}", "ihsrr", {rays: (1, 2, 3) for rays in ladder})
        for method, worlds in LADDERS.items():
            for rooms, ladder in worlds.items():
                if furniture and rooms == 64:
                    continue  # would take hours
                scene = f"maze:{rooms}{':furniture' if furniture else ''}"
                seeds = {rays * (4 if furniture else 1): (1, 2, 3) if rays <= 4 else (1,) for rays in ladder}
                measure_errors(bench, scene, scene, COMPARED[rooms], method, seeds)


def measure_errors(bench: Bench, case: str, scene: str, view: str, method: str, seeds: dict[float, tuple]) -> None:
    """@param seeds  By million rays."""
    reference, noise = bench.reference(scene, f"--view {view}", "160x90", 256)
    wanted = luminance(read_exr(reference))
    kept, scale = ~is_near_lamp(wanted), wanted**2 + (0.01 * wanted.mean()) ** 2
    for rays, numbers in seeds.items():
        for seed in numbers:
            options = f"--view {view} --method {method} --rays {int(rays * 1e6)} --seed {seed}"

            def errors():
                stats = bench.solve(scene, options)
                picture = luminance(read_exr(bench.picture(f"--view {view}", "--size 160x90 --samples 64 --shading flat")))
                error = np.mean((((picture - wanted) ** 2 - noise**2) / scale)[kept])
                return {"relative MSE": error, "elements": stats["elements"], "seconds": stats["seconds"]}

            bench.measure("f", f"{case} {method} {rays:g}", seed, f"solve {scene} {options}", errors)


def needed(bench: Bench, case: str, method: str):
    """Returns the million rays and elements for SAME_ERROR, and whether they are extrapolated; None with fewer than two
    measurements."""
    errors, elements = bench.values("f", "relative MSE"), bench.values("f", "elements")
    prefix = f"{case} {method} "
    cases = sorted((float(c.removeprefix(prefix)), c) for c in errors if c.startswith(prefix) and np.mean(errors[c]) > 0)
    if len(cases) < 2:
        return None
    x = np.array([rays for rays, _ in cases])
    rays, extrapolated = crossing(x, np.array([np.mean(errors[c]) for _, c in cases]), SAME_ERROR)
    count = math.exp(np.interp(math.log(rays), np.log(x), [math.log(np.mean(elements[c])) for _, c in cases]))
    return rays, count, " (extrapolated)" if extrapolated else ""


def table_f(bench: Bench):
    for furniture in ("", " --furniture"):
        smallest = needed(bench, f"9 rooms{furniture}", "ihsrr")
        for rooms in list(WITHIN.values())[1:]:
            found = needed(bench, f"{rooms} rooms{furniture}", "ihsrr")
            if smallest and found:
                figure = f"{found[0] / smallest[0]:.2f} ({found[0]:.2g} M rays, {found[1]:,.0f} elements){found[2]}"
                name = f"{rooms} rooms{', furnished' if furniture else ''}"
                yield f"rays for one error over those with 9 rooms around the same view, ihsrr: {name}", "1.2 at most", figure, 3
        for rooms in COMPARED:
            scene = f"maze:{rooms}{':furniture' if furniture else ''}"
            few, many = needed(bench, scene, "ihsrr"), needed(bench, scene, "hsrr")
            if few and many:
                figure = f"{few[0] / many[0]:.3f} of the rays, {few[1] / many[1]:.3f} of the elements{few[2] or many[2]}"
                target = {1: "1.05", 16: "0.15", 64: "0.04"}[rooms]
                yield f"ihsrr over hsrr at one error: {scene}", target, figure, "1 to 3"


ROWS = {
    "a": (measure_a, table_a),
    "b": (measure_b, table_b),
    "c": (measure_c, table_c),
    "d": (measure_d, table_d),
    "e": (measure_e, table_e),
    "f": (measure_f, table_f),
    "g": (measure_g, table_g),
    "h": (measure_h, table_h),
}
ORDER = "edgbhfac"  # cheap ones first


def main(rows: str = ORDER, only_draw: bool = False) -> None:
    bench = Bench()
    for row in () if only_draw else rows:
        ROWS[row][0](bench)
    lines = [[row, *map(str, line)] for row, (_, table) in ROWS.items() for line in table(bench)]
    table = program.ROOT / "docs/figures/acceptance.md"
    results.write_table(table, ["", "what", "target", "found", "seeds"], lines)
    print(table.read_text(), end="")


if __name__ == "__main__":
    main(*sys.argv[1:2])

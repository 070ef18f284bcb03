"""Runs on damaged or mutated inputs."""

import check
from case import BAD_INPUT, DONE, Case
from mutate import BINARY, JSON, TEXT, mutated, substitute_number
from seeds import ENTITIES, PICTURES, SCENE, TINY

READ = frozenset({DONE, BAD_INPUT})
FEW_PATCHES = ("--max-patches", "20k")
FEW_RAYS = ("--rays", "1k", "--time", "0.5")
ONE_THREAD = ("--threads", "1")
SMALL = ("--size", "8x6", "--samples", "2")
EYE = ("--eye", "1,1,1", "--look-at", "2,2,.5")


def info(scene):
    return {"arguments": ["info", scene, *FEW_PATCHES]}


def info_json(scene):
    return {"arguments": ["info", scene, "--json", *FEW_PATCHES]}


def solve(scene, *options):
    return {
        "arguments": ["solve", scene, "-o", "out.h5", "--stats", "stats", *FEW_RAYS, *FEW_PATCHES, *ONE_THREAD, *options],
        "outputs": ("out.h5", "stats"),
        "checks": (check.can_be_drawn("out.h5"), check.stats_are_finite("stats")),
        "seconds": 0.5,
    }


def draw(scene, *options):
    return {
        "arguments": ["render", scene, "-o", "out.exr", *SMALL, *FEW_PATCHES, *ONE_THREAD, *options],
        "outputs": ("out.exr",),
        "checks": (check.picture_is_finite("out.exr"),),
        "seconds": 0.5,
    }


def render(scene, *options):
    return draw(scene, *FEW_RAYS, *options)


def path_trace(scene, *options):
    return draw(scene, "--shading", "path", *options)


def case_of(use, description, files, **more):
    """A case with mutated files, which are either refused or read without faults."""
    return Case(description=description, files=files, allowed=READ, memory=True, **use, **more)


def scene(rng, seeds, _):
    names = rng.choice((SCENE, ENTITIES))
    files = seeds.some(*names)
    target = rng.choice((names[0], names[0], names[0], "part.mgf")) if names is ENTITIES else names[0]
    files[target], how = mutated(rng, files[target], TEXT, 4)
    use = rng.choice((info, info_json, solve, solve, render, path_trace))
    needs_eye = names is ENTITIES and use in (render, path_trace)
    return case_of(use(names[0], *(EYE if needs_eye else ())), f"{target}: {how}", files)


def named_views(rng, seeds, _):
    files = seeds.some(*SCENE)
    files["room.views.json"], how = mutated(rng, files["room.views.json"], JSON, 3)
    use = rng.choice((info, info_json, solve, render, path_trace))
    options = ("--view", "room-0") if use in (solve, path_trace) else ()
    return case_of(use("room.mgf", *options), f"room.views.json: {how}", files)


def view_file(rng, seeds, _):
    files = seeds.some(*SCENE, "corner.vf")
    files["corner.vf"], how = mutated(rng, files["corner.vf"], TEXT, 3)
    use = rng.choice((solve, render, path_trace))
    return case_of(use("room.mgf", "--view-file", "corner.vf"), f"corner.vf: {how}", files)


def picture(rng, seeds, _):
    files = seeds.some(*PICTURES)
    target = rng.choice(PICTURES)
    mutators = (*BINARY, substitute_number) if target == "a.hdr" else BINARY
    files[target], how = mutated(rng, files[target], mutators, 4)
    pair = [target, rng.choice(PICTURES)]
    rng.shuffle(pair)
    options, outputs = rng.choice((([], ()), (["--json"], ()), (["--difference", "out.png"], ("out.png",))))
    use = {"arguments": ["compare", *pair, *options], "outputs": outputs}
    return case_of(use, f"{target}: {how}", files)


def solution(rng, seeds, _):
    """Damages a solution, which is always refused."""
    damaged, how = mutated(rng, seeds.files["room.h5"], BINARY, 1)
    return Case(
        description=f"room.h5: {how}",
        arguments=["render", "room.h5", "-o", "out.exr", "--view", "room-0", *TINY, *ONE_THREAD],
        files={"room.h5": damaged},
        allowed=READ,
        may_leave=("out.exr",),
        checks=(check.damage_is_refused("out.exr", seeds.written["render .exr"]["out.exr"]),),
    )

"""Runs that are stopped and resumed. They have the bytes of an undisturbed run, with any source, method and option."""

import re
import signal

import check
from case import DONE, INTERRUPTED, RESULT, Case, Fault, Signal, signal_name

# A room of 4 x 3 x 2.5 m without the north wall, with a box; its walls have an image.
PLACES = ((0, 0, 0), (4, 0, 0), (4, 3, 0), (0, 3, 0), (0, 0, 2.5), (4, 0, 2.5), (4, 3, 2.5), (0, 3, 2.5))
PLACES += ((1, 1, 2.4), (1, 2, 2.4), (2, 2, 2.4), (2, 1, 2.4), (2, 0.5, 0), (3, 0.5, 0), (3, 1, 0), (2, 1, 0.8))
ROOM = "".join(f"v v{k} =\n\tp {x} {y} {z}\n\tuv {0.3 * x + z} {0.7 * y - z}\n" for k, (x, y, z) in enumerate(PLACES))
ROOM += "m wall =\n\trd .7\n\ttexture rd a.png\no walls\nf v0 v1 v2 v3\nf v4 v7 v6 v5\nf v0 v3 v7 v4\nf v1 v5 v6 v2\nf v0 v4 v5 v1\no\n"
ROOM += "m box =\n\trd .4\n\trs .1 .1\no box\nf v12 v13 v15\nf v13 v14 v15\no\n"
PANE = "m glass =\n\trd .1\n\tts .6 0\no pane\nf v3 v2 v6 v7\no\n"
LAMP = "m lamp =\n\tsides 1\n\trd .2\n\ted {exitance}\no lamp\nf v8 v9 v10 v11\no\n"
DOWN = "v down =\n\tp 3 2 2\n\tn 1 -1 -3\n"

# Text of the sources in the scene, and options of the command.
SOURCES = {
    "lamp": (LAMP.format(exitance=1000), ()),
    "image": (LAMP.format(exitance="1000\n\ttexture ed a.png"), ()),
    "point": (DOWN + "light point down 100\n", ()),
    "spot": (DOWN + "light spot down 100 20 50\n", ()),
    "directional": (DOWN + "light directional down 5000\n", ()),
    "ies": ("ies lamp.ies -t 2 1.5 2.2\n", ()),
    "luminaire": ("", ("--luminaire", "lamp.ies@1,1,2.2,3,2,0,turn=20")),
    "sky": ("light sky 1500\n", ()),
    "overcast": ("", ("--sky", "overcast", "--ground", "0.2")),
    "clear": ("", ("--sky", "clear", "--sun", "20,35")),
    "perez": ("", ("--sky", "perez:400,150", "--sun", "350,50")),
    "cie": ("", ("--sky", "cie-9:8000", "--sun", "10,30,20000")),
    "sun": ("", ("--sun", "15,40")),
    "environment": ("", ("--environment", "a.hdr,30,50")),
}
ALL_SURFACES = ("lamp", "image")
VIEW = ("--eye", "0.3,0.2,1.6", "--look-at", "2,3,1")
# Options that change the light, and methods that accept them (all, if empty).
PASSES = ("srr", "isrr", "hsrr", "ihsrr")
OPTIONS = (
    ((), ()),
    (("--keep-direct",), PASSES),
    (("--points", "random"), ()),
    (("--seed", "77"), ()),
    (("--refinement-criterion", "power"), ("hsrr", "ihsrr", "hwdrs", "ihwdrs")),
    (("--refinement-criterion", "perceptual"), ("ihsrr", "ihwdrs")),
    (("--one-bounce",), ("srr", "isrr", "hsrr", "ihsrr")),
    (("--separate-iterations",), ("ihsrr", "ihwdrs")),
    (("--importance", "direct"), ("ihsrr", "ihwdrs")),
    (("--importance-at-patches",), ("ihsrr",)),
    (("--no-shrinkage",), ("hsrr", "ihsrr")),
    (("--no-clusters",), ("hsrr", "ihsrr")),
    (("--warm-up", "2"), PASSES),
    (("--rays-per-iteration", "30k"), PASSES),
    (("--min-area", "0.01"), ("hsrr", "ihsrr", "hr")),
    (("--light-groups",), PASSES),
    (("--mesh-size", "0.4"), ()),
)
SURFACES_ALONE = ("hr", "pr", "global-lines")  # see Method::takes_luminaires
RAYS = ("--rays", "300k")
LATEST = 1.0  # [s] after the start, by when most runs have ended
SAVED = ("run.h5", "run.previous.h5", "out.h5")
HEEDED = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)


def methods(seeds):
    return re.search(r"--method (\S+)", seeds.helps[("solve",)])[1].split("|")


def has_bytes_of_undisturbed_run(options):
    """Resumes the stopped run, if it has a checkpoint, and compares it with a run that is left alone."""

    def check_bytes(run):
        faults = check.succeeds(run, "solve", "room.mgf", "-o", "whole.h5", *options)
        name = "out.h5"
        if not faults and run.exit_code != DONE:
            if not run.has_file("run.h5"):
                return
            name = "resumed.h5"
            faults = check.succeeds(run, "resume", "run.h5", "-o", name)
        yield from faults
        if not faults and run.bytes(name) != run.bytes("whole.h5"):
            yield Fault(RESULT, f"{name} differs from an undisturbed run: {' '.join(options)}")

    return check_bytes


def resumed(rng, seeds, number):
    method = methods(seeds)[number % len(methods(seeds))]
    sources = [name for name in SOURCES if name in ALL_SURFACES or method not in SURFACES_ALONE]
    chosen = rng.sample(sources, rng.choice((1, 1, 2)))
    if all(SOURCES[name][1] for name in chosen):
        chosen = chosen[:1]  # the options of daylight may not be repeated
    more, _ = rng.choice([each for each in OPTIONS if not each[1] or method in each[1]])
    options = [*RAYS, "--method", method, *more]
    if method.startswith("i") or "--importance" in more or rng.random() < 0.3:
        options += VIEW
    for name in chosen:
        options += SOURCES[name][1]
    scene = ROOM + rng.choice(("", PANE)) + "".join(SOURCES[name][0] for name in chosen)
    sent = Signal(rng.choice(HEEDED), rng.uniform(0.05, LATEST))
    return Case(
        description=f"{' and '.join(chosen)}, {signal_name(sent.number)} after {sent.delay:.3f} s: {' '.join(options)}",
        arguments=["solve", "room.mgf", "-o", "out.h5", "--checkpoint", "run.h5", "--every", "0.1s", *options],
        files={**seeds.some("lamp.ies", "a.png", "a.hdr"), "room.mgf": scene.encode()},
        allowed=frozenset({DONE, INTERRUPTED, -sent.number}),
        may_leave=SAVED,
        signals=(sent,),
        seconds=3 * LATEST,
        checks=(has_bytes_of_undisturbed_run(options),),
    )

"""Option values at and beyond the limits of their types. The options are read from the command's help."""

import re
import signal
from dataclasses import dataclass

import check
from case import BAD_INPUT, DONE, INTERRUPTED, WRONG_USAGE, Case, Signal
from seeds import PICTURES, SCENE, SOLUTION

OPTION = re.compile(r"^  (?:-\w,)?(--[\w-]+)(?:,(--[\w-]+))?(?:\{false\})?(?: (\S+)(?: in \[(\S+) - (\S+)\])?)?", re.MULTILINE)
NOT_VARIED = {"--help", "--version", "--output", "--stats", "--view", "--view-file", "--difference", "--error-image", "--json"}
LIMITS = {"--rays", "--time"}  # every solve has one of these
TIME = 0.3  # [s] limit for solves
TOO_LONG = 1.5  # [s] after which a run without a time limit is ended
LARGEST_PICTURE = "16384x16384"
SECONDS_TO_GET_ITS_MEMORY = 10  # for 3 GiB, page by page

NO_NUMBERS = ("", " ", "nan", "-nan", "inf", "-inf", "1e400", "x", "1 2", "1e", "--1", "1\x1b[31m", "\u0663", "1,5,", "0x")
NUMBERS = ("0", "-1", "1", "2", "0.5", "-0", "+1", "007", "1e-45", "1e-400", "1e18", "1e19", "1e38", "1e39", "1e300", "-1e300")
NUMBERS += ("127", "128", "65535", "65536", "2147483647", "2147483648", "4294967295", "4294967296", "9223372036854775807")
NUMBERS += ("9223372036854775808", "18446744073709551615", "18446744073709551616", "9" * 400, "0x10", "50%", "100%", "1T", "1k")
# Plausible extreme values for each type in the help.
TYPICAL = {
    "AZIMUTH,ALTITUDE[,LUX]": ("200,35", "0,90", "-720,1e-6", "90,45,0", "90,45,1e10"),
    "AREA": ("0", "1e-12", "1e-300", "1e11", "1"),
    "BYTES": ("1", "120M", "200M", "1T", "1e18"),
    "COUNT": ("1", "2", "1k", "100k", "1e11", "1e18"),
    "DEGREES": ("0.001", "1", "179"),
    "EXPONENT": ("0", "1", "0.5", "1e-30"),
    "FLOAT": ("0.001", "0.5", "1", "179"),
    "MODEL[": ("overcast", "clear:9000", "uniform:0", "cie-16:1e10", "perez:650,120", "perez:0,1e-9"),
    "METRES|auto|none": ("0.1", "0.3", "1e3", "1e15", "auto", "none"),
    "NUMBER": ("0", "1", "18446744073709551615"),
    "SECONDS": ("1e-9", "1e-300", "0.1", "1e9", "1e18", "1e300"),
    "SHARE": ("0", "1e-15", "0.5", "1", "99%", "1e-9%", "1e15"),
    "STOPS": ("-100", "-20", "0", "20", "100"),
    "TEXT": ("1", "50", "1k"),
    "UINT": ("0", "1", "4294967295", "18446744073709551615"),
    "WxH": ("1x1", "1x16384", "16384x1", "64x3", LARGEST_PICTURE),
}
MUCH_WORK = ("--rays-per-iteration=1e11", "--rays-per-iteration=1e9", "--camera-rays=4194304")
MUCH_WORK += ("--warm-up=1000000", "--min-area=1e-12")
COORDINATES = ("0", "1", "-1", "1.3", "0.3", "1e-45", "1e-30", "1e-6", "1e3", "1e7", "-1e10", "1e14", "1e15")
BEYOND = ("1e16", "1e18", "1e30", "1e38", "-3.4e38", "1e39", "1e300")  # for the camera position
ACCEPTED_OR_REFUSED = frozenset({DONE, WRONG_USAGE, BAD_INPUT})
REFUSED = frozenset({WRONG_USAGE, BAD_INPUT})


@dataclass(frozen=True)
class Option:
    """@param type  As in the help: INT, COUNT, X,Y,Z, a|b|c; empty for a switch.
    @param ends  Ends of its range, if the help states them."""

    name: str
    type: str
    ends: tuple[str, ...]


def options_in(help_text):
    found = []
    for name, opposite, type_text, *ends in OPTION.findall(help_text):
        kind = re.split("[:=]", type_text)[0] if re.match(r"[A-Z]|[\w-]+\|", type_text) else ""
        known_ends = tuple(filter(None, ends))
        found += [Option(each, kind, known_ends) for each in (name, opposite) if each and each not in NOT_VARIED]
    return found


def number(rng):
    return rng.choice(NO_NUMBERS) if rng.random() < 0.3 else rng.choice(NUMBERS)


def typical(rng, option):
    if option.type == "X,Y,Z":
        return ",".join(rng.choice(COORDINATES) for _ in range(3))
    if "|" in option.type and option.type not in TYPICAL:
        return rng.choice(option.type.split("|"))
    return rng.choice(option.ends or TYPICAL.get(option.type, NUMBERS))


def odd(rng, option):
    if option.type == "X,Y,Z":
        return ",".join(number(rng) for _ in range(rng.choice((3, 3, 2, 4))))
    return "x".join(number(rng) for _ in range(2)) if option.type == "WxH" else number(rng)


def value_of(rng, option):
    return typical(rng, option) if rng.random() < 0.75 else odd(rng, option)


def some_choices(rng, seeds, subcommand, most, without=LIMITS, value=value_of):
    """Returns up to `most` options of a subcommand, each with its own value."""
    known = [option for option in options_in(seeds.helps[subcommand]) if option.name not in without]
    chosen = rng.sample(known, rng.randint(1, most))
    return [f"{option.name}={value(rng, option)}" if option.type else option.name for option in chosen]


def names(words):
    return {word.split("=")[0] for word in words if word.startswith("--")}


def is_refused(words):
    """Returns whether one of the options has a value that is not a number."""
    return any(word.partition("=")[2] in NO_NUMBERS for word in words if "=" in word)


# ---- solves that must keep their time limit


def solve_with(arguments, seeds):
    arguments = ["solve", "room.mgf", "-o", "out.h5", "--stats", "stats", *arguments]
    checks = (check.can_be_drawn("out.h5"), check.stats_are_finite("stats"))
    return Case(
        description=" ".join(arguments),
        arguments=arguments,
        files=seeds.some(*SCENE),
        allowed=ACCEPTED_OR_REFUSED,
        outputs=("out.h5", "stats"),
        memory=True,
        seconds=TIME,
        checks=checks,
    )


def time_limits(rng, seeds, _):
    """A time limit combined with options that ask for a lot of work."""
    chosen = some_choices(rng, seeds, ("solve",), most=3, value=typical)
    work = rng.choice(MUCH_WORK)
    chosen += [work] if not names([work]) & names(chosen) else []
    return solve_with([*looking(chosen), "--time", str(TIME), *chosen], seeds)


# ---- one function per subcommand, with the limits that the options leave open


def limits_besides(chosen, **limits):
    return [word for name, value in limits.items() if f"--{name}" not in names(chosen) for word in (f"--{name}", value)]


def looking(chosen):
    if not {"--eye", "--look-at"} & names(chosen):
        return ["--view", "room-0"]
    return [word for name in ("--eye", "--look-at") if name not in names(chosen) for word in (name, "1,1.3,1.1")]


def solve(rng, seeds):
    varied = rng.choice(tuple(LIMITS))  # the other limit stays fixed
    chosen = some_choices(rng, seeds, ("solve",), most=3, without=LIMITS - {varied})
    limit = limits_besides(chosen, rays="2k") if "--time" in names(chosen) else limits_besides(chosen, time=str(TIME))
    more = rng.choice(([], ["--rays", "2k"])) if not {"--rays", "--time"} & names(chosen) else []
    return solve_with([*looking(chosen), *limit, *more, *chosen], seeds)


def draw(rng, seeds, inputs, *options):
    chosen = some_choices(rng, seeds, ("render",), most=3, without=LIMITS)
    small = limits_besides(chosen, size="8x6", samples="2")
    arguments = ["render", inputs[0], "-o", "out.exr", *looking(chosen), *small, *options, *chosen]
    return Case("", arguments, seeds.some(*inputs), outputs=("out.exr",), checks=(check.picture_is_finite("out.exr"),))


def render_scene(rng, seeds):
    return draw(rng, seeds, SCENE, "--rays", "2k", "--time", str(TIME))


def render_solution(rng, seeds):
    return draw(rng, seeds, SOLUTION)


def probe(rng, seeds):
    chosen = some_choices(rng, seeds, ("probe",), most=3, without=LIMITS)
    inputs = rng.choice((SCENE, SOLUTION))
    least = ["--rays", "2k", "--time", str(TIME)] if inputs is SCENE else []
    places = [] if {"--grid", "--plane", "--point", "--line", "--surface"} & names(chosen) else ["--plane", "1"]
    small = limits_besides(chosen, samples="4", spacing="0.5")
    return Case("", ["probe", inputs[0], "--json", *places, *small, *least, *chosen], seeds.some(*inputs))


def report(rng, seeds):
    chosen = some_choices(rng, seeds, ("report",), most=3, without=LIMITS)
    small = limits_besides(chosen, size="8x6", samples="4")
    return Case("", ["report", "room.h5", "-o", "out.html", *small, *chosen], seeds.some(*SOLUTION), outputs=("out.html",))


def compare(rng, seeds):
    chosen = some_choices(rng, seeds, ("compare",), most=2)
    return Case("", ["compare", "a.exr", "a.hdr", "--json", *chosen], seeds.some(*PICTURES))


def info(rng, seeds):
    chosen = some_choices(rng, seeds, ("info",), most=2)
    return Case("", ["info", "room.mgf", "--json", *chosen], seeds.some(*SCENE))


def bench(rng, seeds):
    chosen = some_choices(rng, seeds, ("bench",), most=2, without=())
    small = limits_besides(chosen, rays="1k", rounds="1")
    return Case("", ["bench", "room.mgf", "--json", *small, *chosen], seeds.some(*SCENE))


def make_scene(rng, seeds):
    kind = rng.choice([words for words in seeds.helps if words[0] == "make-scene"])
    chosen = some_choices(rng, seeds, kind, most=2)
    textures = tuple(f"out.texture-{i}.png" for i in range(3)) if "--texture" in chosen else ()
    outputs = ("out.mgf", "out.views.json", *textures)
    return Case("", [*kind, "-o", "out.mgf", *chosen], outputs=outputs, checks=(check.scene_can_be_read("out.mgf"),))


def ended_when_too_long(case):
    """A large task may take long. A signal ends it, and its outputs are then complete or missing."""
    case.signals = (Signal(signal.SIGTERM, TOO_LONG),)
    case.seconds += TOO_LONG
    if any(LARGEST_PICTURE in argument for argument in case.arguments):
        case.seconds += SECONDS_TO_GET_ITS_MEMORY
    case.allowed |= {INTERRUPTED, -signal.SIGTERM}
    return case


def options(rng, seeds, _):
    make = rng.choice((solve, solve, solve, render_scene, render_solution, probe, report, compare, info, bench, make_scene))
    case = make(rng, seeds)
    case.description = " ".join(case.arguments)
    case.memory = True
    case.allowed = REFUSED if is_refused(case.arguments) else ACCEPTED_OR_REFUSED
    return case if make is solve else ended_when_too_long(case)


def far_point(rng):
    component = BEYOND if rng.random() < 0.1 else COORDINATES
    return ",".join(rng.choice(component) for _ in range(3))


def camera(rng):
    chosen = ["--eye=" + rng.choice(("1,1.3,1.1", far_point(rng))), "--look-at=" + far_point(rng)]
    if rng.random() < 0.3:
        chosen.append("--up=" + far_point(rng))
    if rng.random() < 0.5:
        chosen.append("--fov=" + rng.choice(("0.001", "0.01", "179", "178.9", "1e-5", "179.99999")))
    return chosen


def solve_for(chosen, seeds):
    arguments = ["solve", "room.mgf", "-o", "out.h5", "--rays", "1k", "--time", str(TIME), *chosen]
    checks = (check.can_be_drawn("out.h5"),)
    return Case("", arguments, seeds.some(*SCENE), outputs=("out.h5",), seconds=TIME, checks=checks)


def picture_of(chosen, rng, seeds):
    name = rng.choice(("out.exr", "out.hdr", "out.png"))
    shading = rng.choice(([], ["--shading", "flat"], ["--shading", "path"], ["--show", "error"], ["--show", "mesh"]))
    inputs = SCENE if "path" in shading else SOLUTION
    small = ["--size", rng.choice(("8x6", "1x1", "64x1")), "--samples", "2"]
    checks = () if name == "out.png" else (check.picture_is_finite(name),)
    arguments = ["render", inputs[0], "-o", name, *small, *shading, *chosen]
    return Case("", arguments, seeds.some(*inputs), outputs=(name,), checks=checks)


def cameras(rng, seeds, _):
    """Cameras at and aimed at extreme coordinates."""
    chosen = camera(rng)
    case = solve_for(chosen, seeds) if rng.random() < 0.3 else picture_of(chosen, rng, seeds)
    case.allowed, case.description = ACCEPTED_OR_REFUSED, " ".join(case.arguments)
    return case

"""Runs with unusual file names."""

import os

import check
from case import BAD_INPUT, DONE, WRONG_USAGE, Case
from seeds import ENTITIES, PICTURES, ROOM_RAYS, SCENE, TINY, WRITERS

REFUSED = frozenset({BAD_INPUT})
NAME_REFUSED = frozenset({WRONG_USAGE, BAD_INPUT})  # before anything is read, or when the file is written
SECONDS_TO_READ = 45  # through a pipe: with a sanitizer on a busy machine, a report takes over 15 s
LONGEST_NAME = 255  # bytes, in most file systems
ODD = ("with space", " ", "new\nline", "\x1b[31mred", "tab\tand\rreturn", "caf\u00e9", "\udcff\udcfe")
ODD += ("\udcc3(", "'\"$(id)`", "*?[a]")
ODD += ("a" * 200, "%s%n{}", "..", "...", "sub/../sub/deep", "./././x", "a:b", "\u202eabc", "{0}", "#", "~", "nan", "\\")


def as_bytes(text):
    return text.encode("utf-8", "surrogateescape")


def folder_of(name):
    def prepare(folder):
        for parent in (os.path.dirname(name), os.path.dirname(os.path.normpath(name))):
            os.makedirs(folder / parent, exist_ok=True)

    return prepare


def shows_no_controls(odd):
    """Messages escape control characters in names."""

    def check_messages(run):
        if "\n" in odd and as_bytes(odd) in run.stderr + run.stdout:
            yield check.Fault(check.MESSAGE, f"the line break in a name is shown as it is: {check.last_line(run.stderr)}")

    return check_messages


def odd_scene(rng, seeds):
    odd = rng.choice(ODD)
    name = f"./{odd}.mgf"
    solve = ["solve", name, "-o", "out.h5", *ROOM_RAYS]
    use, outputs = rng.choice(((["info", name], ()), (["info", name, "--json"], ()), (solve, ("out.h5",))))
    files = {os.path.normpath(name): seeds.files["room.mgf"]}
    checks = (check.can_be_drawn("out.h5"), shows_no_controls(odd)) if outputs else (shows_no_controls(odd),)
    return Case(f"scene {name!a}", use, files, outputs=outputs, checks=checks, prepare=folder_of(name))


def missing_input(rng, seeds):
    odd = rng.choice(ODD)
    solve = ["solve", "room.mgf", "-o", "out.h5"]
    uses = (
        ["info", f"{odd}.mgf"],
        ["render", f"{odd}.h5", "-o", "out.png"],
        ["compare", f"{odd}.exr", "a.exr"],
        [*solve, "--view-file", f"{odd}.vf"],
        [*solve, "--view", odd],
    )
    use = rng.choice(uses)
    return Case(f"no {odd!a}", use, seeds.some(*SCENE, *PICTURES), allowed=REFUSED, checks=(shows_no_controls(odd),))


def odd_text_inside(rng, seeds):
    """Unusual names within a scene, which messages and descriptions repeat."""
    odd = rng.choice([name for name in ODD if not set(name) & set(" \n\r\t")])
    word = rng.choice((b"shelf", b"wall", b"lamp", b"part.mgf", b"lamp.ies"))
    files = seeds.some(*ENTITIES)
    files["entities.mgf"] = files["entities.mgf"].replace(word, as_bytes(odd))
    use = rng.choice((["info"], ["info", "--json"], ["solve", "-o", "out.h5", *ROOM_RAYS]))
    outputs = ("out.h5",) if "solve" in use else ()
    return Case(
        description=f"{word.decode()} is {odd!a}",
        arguments=[use[0], "entities.mgf", *use[1:]],
        files=files,
        allowed=frozenset({DONE, BAD_INPUT}),
        outputs=outputs,
        checks=(check.can_be_drawn("out.h5"),),
    )


def named_output(rng, seeds, odd, description, **more):
    key = rng.choice([key for key in WRITERS if key != "make-scene"])
    command = WRITERS[key]
    suffix = os.path.splitext(command.output())[1]
    name = odd + suffix
    arguments = [name if word == command.output() else word for word in command.arguments]
    outputs = (os.path.normpath(name), *command.outputs[1:])
    expected = {outputs[0]: seeds.written[key][command.output()]}
    more.setdefault("prepare", folder_of(name))
    more.setdefault("checks", (check.same_bytes(expected),))
    return Case(f"{key}: {description} {name[:40]!a}", arguments, seeds.some(*command.inputs), outputs=outputs, **more)


def odd_output(rng, seeds):
    odd = rng.choice(ODD)
    return named_output(rng, seeds, f"./{odd}", "writes")


def longest_name(rng, seeds):
    return named_output(rng, seeds, "n" * (LONGEST_NAME - 4 + rng.choice((0, -1, -10))), "writes")


def too_long_name(rng, seeds):
    odd = rng.choice(("n" * LONGEST_NAME, "n/" * 3000))
    return named_output(rng, seeds, odd, "writes", allowed=NAME_REFUSED, prepare=None)


def leading_dash(rng, seeds):
    allowed = frozenset({DONE, WRONG_USAGE, BAD_INPUT})
    return named_output(rng, seeds, rng.choice(("-x", "--rays", "-", "--")), "writes", allowed=allowed)


def in_missing_folder(rng, seeds):
    return named_output(rng, seeds, "nowhere/deep/out", "writes", allowed=NAME_REFUSED, prepare=None)


def over_a_folder(rng, seeds):
    key = rng.choice(list(WRITERS))
    command = WRITERS[key]

    def prepare(folder):
        (folder / command.output()).mkdir()

    files = seeds.some(*command.inputs)
    return Case(f"{key}: over a folder", list(command.arguments), files, allowed=NAME_REFUSED, prepare=prepare)


def through_link(rng, seeds):
    """The target of a link is written and the link stays. The target or its folder may be missing."""
    target, allowed = rng.choice((("target", DONE), ("missing", DONE), ("nowhere/target", BAD_INPUT), ("out", BAD_INPUT)))
    key = rng.choice([key for key in WRITERS if len(WRITERS[key].outputs) == 1])
    command = WRITERS[key]
    name = command.output()
    target = name if target == "out" else target  # a link to itself

    def prepare(folder):
        (folder / name).symlink_to(target)

    files = seeds.some(*command.inputs) | {"target": b"an earlier result"}
    case = Case(f"{key}: through a link to {target}", list(command.arguments), files, frozenset({allowed}), prepare=prepare)
    case.outputs = (target,) if allowed == DONE else ()
    case.checks = (check.same_bytes({target: seeds.written[key][name]}),)
    return case


def into_pipe(rng, seeds):
    key = rng.choice([key for key in WRITERS if len(WRITERS[key].outputs) == 1])
    command = WRITERS[key]
    name = command.output()

    def prepare(folder):
        os.mkfifo(folder / name)

    case = Case(f"{key}: into a pipe", list(command.arguments), seeds.some(*command.inputs), prepare=prepare)
    case.shell = f"timeout {SECONDS_TO_READ} cat {name} >copy & true"
    case.outputs = ("copy",)
    case.checks = (check.same_bytes({"copy": seeds.written[key][name]}),)
    return case


def scene_through_link(rng, seeds):
    """A link to the scene or to itself, or a folder named like a scene."""
    kind = rng.choice(("file", "loop", "folder", "empty", "pipe that nobody writes"))

    def prepare(folder):
        if kind in ("file", "loop"):
            (folder / "link.mgf").symlink_to("room.mgf" if kind == "file" else "link.mgf")
        elif kind == "folder":
            (folder / "link.mgf").mkdir()
        elif kind == "empty":
            (folder / "link.mgf").write_bytes(b"")
        else:
            (folder / "link.mgf").symlink_to("/dev/null")

    allowed = frozenset({DONE if kind == "file" else BAD_INPUT})
    use = rng.choice((["info", "link.mgf"], ["solve", "link.mgf", "-o", "out.h5", *ROOM_RAYS]))
    outputs = ("out.h5",) if use[0] == "solve" else ()
    return Case(f"scene is a {kind}", use, seeds.some(*SCENE), allowed, outputs, prepare=prepare)


def same_file_twice(rng, seeds):
    """No output replaces an input or another output, under any name."""
    other = rng.choice(("", "./", "../run/"))
    uses = (
        ["solve", "room.mgf", "-o", "out.h5", "--stats", other + "out.h5", *ROOM_RAYS],
        ["solve", "room.mgf", "-o", "out.h5", "--stats", other + "room.mgf", *ROOM_RAYS],
        ["solve", "room.mgf", "-o", "out.h5", "--stats", other + "room.views.json", "--view", "room-0", *ROOM_RAYS],
        ["solve", "room.mgf", "-o", "out.h5", "--view-file", "corner.vf", "--stats", other + "corner.vf", *ROOM_RAYS],
        ["render", "room.mgf", "-o", "out.exr", "--error-image", other + "out.exr", "--shading", "path", *TINY],
        ["compare", "a.png", "b.exr", "--difference", other + "a.png"],
        ["compare", "b.exr", "a.png", "--difference", other + "a.png"],
    )
    files = seeds.some(*SCENE, *PICTURES, "corner.vf")
    use = rng.choice(uses)
    return Case(f"same file twice: {' '.join(use)}", use, files, allowed=NAME_REFUSED)


def read_only_folder(rng, seeds):
    """An output in a read-only folder is refused, except for root, who may write anywhere."""

    def prepare(folder):
        (folder / "locked").mkdir(mode=0o555)

    allowed = frozenset({DONE}) if os.geteuid() == 0 else REFUSED
    return named_output(rng, seeds, "locked/out", "writes", prepare=prepare, allowed=allowed)


SCENARIOS = (odd_scene, odd_output, missing_input, odd_text_inside, longest_name, too_long_name, leading_dash)
SCENARIOS += (in_missing_folder, over_a_folder, through_link, into_pipe, scene_through_link, same_file_twice, read_only_folder)


def paths(rng, seeds, number):
    return SCENARIOS[number % len(SCENARIOS)](rng, seeds)

"""Runs that the system disturbs: signals, full disks, limits, closed descriptors."""

import os
import signal
import subprocess

import check
from case import BAD_INPUT, DONE, FAILED, INTERRUPTED, WRONG_USAGE, Case, Signal, signal_name
from kinds.options import some_choices, typical
from seeds import ROOM_RAYS, SCENE, TELLERS, WRITERS

HEEDED = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
LAST_PROGRESS = b"100%"  # the solve has finished and its solution is being written
ENDLESS = ("--rays", "1e18")
SLOW_TO_WRITE = ("--mesh-size", "0.07", "--rays", "2k", "--one-bounce")  # megabytes: signals arrive during the write
SLOW_SECONDS = 3  # allowance beside other work
FEW_DESCRIPTORS = (4, 5, 6, 8, 16)
FEW_DESCRIPTORS_SANITIZED = (16, 24)  # the sanitizer needs some itself and reports their lack as a fault


# ---- signals


def solve_room(*options):
    return ["solve", "room.mgf", "-o", "out.h5", *options]


def signalled(seeds, description, arguments, signals, allowed, checks, **more):
    what = " and ".join(f"{signal_name(s.number)} {s.delay:.3f} s after {s.follows.decode() or 'the start'}" for s in signals)
    keeps = {"files": seeds.some(*SCENE), "outputs": ("out.h5",), "signals": tuple(signals)}
    return Case(f"{description}: {what}", arguments, allowed=frozenset(allowed), checks=tuple(checks), **keeps, **more)


def one_signal(seeds, description, arguments, sent, **more):
    """The result so far is kept. Before the solve, the signal may end the program in its default way."""
    allowed = {DONE, INTERRUPTED, -sent.number}
    checks = [check.interruption("out.h5"), check.can_be_drawn("out.h5")]
    return interrupted_early(signalled(seeds, description, arguments, [sent], allowed, checks, **more))


def interrupted_early(case):
    """Before the solve no output is required; check.interruption covers the later case."""
    case.outputs, case.may_leave = (), case.outputs
    return case


def during_endless_solve(rng, seeds):
    options = some_choices(rng, seeds, ("solve",), most=2, value=typical)
    sent = Signal(rng.choice(HEEDED), rng.uniform(0, 0.8))
    case = one_signal(seeds, "endless solve", solve_room(*ENDLESS, *options), sent, seconds=sent.delay)
    case.allowed |= {WRONG_USAGE, BAD_INPUT}  # errors in the options
    return case


def during_write(rng, seeds):
    sent = Signal(rng.choice(HEEDED), rng.uniform(0, 0.06), follows=LAST_PROGRESS)
    return one_signal(seeds, "write", solve_room(*SLOW_TO_WRITE), sent, seconds=SLOW_SECONDS)


def during_short_solve(rng, seeds):
    sent = Signal(rng.choice(HEEDED), rng.uniform(0, 0.12))
    return one_signal(seeds, "short solve", solve_room(*ROOM_RAYS), sent)


def twice(rng, seeds):
    number = rng.choice(HEEDED)
    first = rng.uniform(0, 0.6)
    signals = [Signal(number, first), Signal(number, first + rng.choice((0, 0.001, 0.05, 0.2)))]
    arguments = solve_room(*ENDLESS, "--rays-per-iteration", rng.choice(("10k", "1e11")))
    allowed = {INTERRUPTED, -number}
    checks = [check.can_be_drawn("out.h5")]
    return interrupted_early(signalled(seeds, "endless solve", arguments, signals, allowed, checks, seconds=first))


def killed(rng, seeds):
    follows = rng.choice((b"", LAST_PROGRESS))
    sent = Signal(signal.SIGKILL, rng.uniform(0, 0.06), follows)
    arguments = solve_room(*(SLOW_TO_WRITE if follows else ROOM_RAYS))
    checks = [check.later_run_tidies_up("out.h5", *solve_room(*ROOM_RAYS))]
    return signalled(seeds, "solve", arguments, [sent], {DONE, -signal.SIGKILL}, checks, seconds=SLOW_SECONDS)


def ignored(rng, seeds):
    """SIGPIPE is ignored; a failed write reports the closed pipe."""
    sent = Signal(signal.SIGPIPE, rng.uniform(0, 0.04), follows=LAST_PROGRESS)
    checks = [check.can_be_drawn("out.h5")]
    return signalled(seeds, "write", solve_room(*SLOW_TO_WRITE), [sent], {DONE}, checks, seconds=SLOW_SECONDS)


def while_drawing(rng, seeds):
    """The picture is either complete or missing."""
    key = rng.choice([key for key in WRITERS if key.startswith(("render", "make-scene", "compare"))])
    command = WRITERS[key]
    sent = Signal(rng.choice(HEEDED), rng.uniform(0, 0.08))
    allowed = {DONE, INTERRUPTED, -sent.number}
    checks = [check.same_bytes(seeds.written[key])]
    case = signalled(seeds, key, list(command.arguments), [sent], allowed, checks)
    case.files, case.outputs, case.may_leave = seeds.some(*command.inputs), (), command.outputs
    return case


def signals(rng, seeds, number):
    kinds = (during_write, during_endless_solve, during_short_solve, twice, killed, during_write, while_drawing, ignored)
    kinds += (during_endless_solve,)
    return kinds[number % len(kinds)](rng, seeds)


# ---- full disks and other limits


def written_case(seeds, key, description, **more):
    """One of WRITERS, disturbed. On success it has written its usual output. On failure it leaves no output; if it has
    several, those that exist are complete."""
    command = WRITERS[key]
    more.setdefault("may_leave", command.outputs if len(command.outputs) > 1 else ())
    return Case(
        description=f"{key}: {description}",
        arguments=list(command.arguments),
        files=seeds.some(*command.inputs),
        outputs=command.outputs,
        checks=(check.same_bytes(seeds.written[key]),),
        **more,
    )


def largest_output(seeds, key):
    return max(map(len, seeds.written[key].values()))


def outcome_of_limit(limit, size):
    """Returns outcomes under a file size limit. Temporary files may be larger than the output."""
    return frozenset({FAILED}) if limit < size else frozenset({DONE, FAILED})


def limited_file_size(rng, seeds, key):
    block = 512  # unit of `ulimit -f` [bytes]
    size = largest_output(seeds, key)
    blocks = rng.choice((0, 1, rng.randrange(1 + size // block), size // block, 1 + size // block))
    allowed = outcome_of_limit(blocks * block, size)
    return written_case(seeds, key, f"files of at most {blocks} blocks", shell=f"ulimit -f {blocks}", allowed=allowed)


def on_full_disk(rng, seeds, key):
    """A file system, mounted at `disk`, with room for only a part of the output."""
    page = 4096  # [bytes]
    pages = 1 + rng.randrange(1 + largest_output(seeds, key) // page)
    mount = ["mount", "-t", "tmpfs", "-o", f"size={pages * page}", "none", "disk"]

    def prepare(folder):
        (folder / "disk").mkdir()
        subprocess.run(mount, cwd=folder, check=True)

    def clean_up(folder):
        subprocess.run(["umount", "-l", "disk"], cwd=folder, check=True)

    command = WRITERS[key]
    moved = {name: f"disk/{name}" for name in command.outputs}
    case = written_case(seeds, key, f"disk of {pages} pages", prepare=prepare, clean_up=clean_up)
    case.arguments = [moved.get(word, word) for word in case.arguments]
    case.outputs = tuple(moved.values())
    case.may_leave = case.outputs if case.may_leave else ()
    expected = {moved[name]: content for name, content in seeds.written[key].items()}
    case.checks = (check.same_bytes(expected),)
    case.allowed = outcome_of_limit(pages * page, sum(map(len, expected.values())))
    return case


def into_full_device(_, seeds, key):
    """The output is a device that accepts no bytes; it must still be a device afterwards."""
    name = WRITERS[key].output()

    def prepare(folder):
        make_full_device(folder / name)

    return written_case(seeds, key, "full device", prepare=prepare, allowed=frozenset({FAILED}))


def make_full_device(path):
    os.mknod(path, 0o020666, os.makedev(1, 7))


def full_disk(rng, seeds, number):
    kinds = [limited_file_size, limited_file_size]
    kinds += [on_full_disk] if seeds.mounts else []
    kinds += [into_full_device] if seeds.makes_devices else []
    return kinds[number % len(kinds)](rng, seeds, rng.choice(list(WRITERS)))


def limits(rng, seeds, number):
    key = rng.choice(list(WRITERS))
    if number % 2 == 0 and not seeds.sanitized:
        mebibytes = rng.choice((256, 384, 512, 768, 1024, 2048))
        limit = {"shell": f"ulimit -v {mebibytes * 1024}", "allowed": frozenset({DONE}), "memory": True}
        return written_case(seeds, key, f"{mebibytes} MiB of addresses", **limit)
    files = rng.choice(FEW_DESCRIPTORS_SANITIZED if seeds.sanitized else FEW_DESCRIPTORS)
    allowed = frozenset({DONE, FAILED, BAD_INPUT})
    return written_case(seeds, key, f"{files} descriptors", shell=f"ulimit -n {files}", allowed=allowed)


# ---- descriptors

CLOSED = {0: "<&-", 1: ">&-", 2: "2>&-"}
FULL = {1: ">full", 2: "2>full"}
NOBODY_READS = {1: "9<>pipe >pipe 9<&-", 2: "9<>pipe 2>pipe 9<&-"}


def some_disturbance(rng, seeds):
    """@return redirections, by descriptor."""
    ways = {0: [CLOSED], 1: [CLOSED, NOBODY_READS], 2: [CLOSED, NOBODY_READS]}
    if seeds.makes_devices:
        ways[1].append(FULL)
        ways[2].append(FULL)
    chosen = rng.choice(([0], [1], [2], [1], [2], [0, 1], [0, 2], [1, 2], [0, 1, 2]))
    return {descriptor: rng.choice(ways[descriptor])[descriptor] for descriptor in chosen}


def descriptors(rng, seeds, number):
    """A failure on stdout is an error for commands that write there. A failure on stderr loses no results."""
    disturbed = some_disturbance(rng, seeds)

    def prepare(folder):
        os.mkfifo(folder / "pipe")
        if seeds.makes_devices:
            make_full_device(folder / "full")

    common = {"prepare": prepare, "redirections": " ".join(disturbed.values())}
    if number % 2 == 0:
        key = rng.choice(list(WRITERS))
        tells = key.startswith("compare") and 1 in disturbed
        allowed = frozenset({FAILED} if tells else {DONE})
        outputs = WRITERS[key].outputs  # complete, even if only the report of them failed
        return written_case(seeds, key, "disturbed descriptors", allowed=allowed, may_leave=outputs, **common)
    key = rng.choice(list(TELLERS))
    allowed = frozenset({FAILED} if 1 in disturbed else {DONE})
    files = seeds.some(*TELLERS[key].inputs)
    return Case(f"{key}: disturbed descriptors", list(TELLERS[key].arguments), files=files, allowed=allowed, **common)

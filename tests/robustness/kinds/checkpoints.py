"""Runs with checkpoints, and runs that resume from one."""

import signal

import check
from case import BAD_INPUT, DONE, FAILED, INTERRUPTED, Case, Signal, signal_name
from mutate import BINARY, mutated
from kinds.options import REFUSED, TIME, ACCEPTED_OR_REFUSED, is_refused, limits_besides, some_choices
from seeds import RESUMED, RUN, SCENE

SAVED = ("run.h5", "run.previous.h5")
ENDLESS = ("--rays", "1e18", "--view", "room-0")
RESUME = ("resume", "run.h5", "-o", "out.h5")


def solve(*options):
    return ["solve", "room.mgf", "-o", "out.h5", "--checkpoint", "run.h5", "--every", "0.1s", *options]


def damaged(rng, seeds):
    content, how = mutated(rng, seeds.files["run.h5"], BINARY, 1)
    return Case(
        description=f"resume of run.h5: {how}",
        arguments=[*RESUME, *RESUMED],
        files={"run.h5": content},
        allowed=frozenset({DONE, BAD_INPUT}),
        outputs=("out.h5",),
        may_leave=SAVED,
        checks=(check.damage_is_refused("out.h5", seeds.resumed),),
    )


def sound(_, seeds):
    """A saved run can be resumed any number of times, with the same result."""
    checks = (check.same_bytes({"out.h5": seeds.resumed}),)
    arguments = [*RESUME, *RESUMED]
    return Case("resume", arguments, seeds.some(*RUN), outputs=("out.h5",), may_leave=SAVED, checks=checks)


def ended_by_signal(rng, seeds):
    """After any signal at any time, the run can resume from its last checkpoint if one was written."""
    sent = Signal(rng.choice((signal.SIGKILL, signal.SIGKILL, signal.SIGINT, signal.SIGTERM)), rng.uniform(0, 0.8))
    goes_on = rng.random() < 0.5
    arguments = [*RESUME, "--every", "0.1s", "--rays", "1e18"] if goes_on else solve(*ENDLESS)
    return Case(
        description=f"{arguments[0]}, {signal_name(sent.number)} after {sent.delay:.3f} s",
        arguments=arguments,
        files=seeds.some(*(RUN if goes_on else SCENE)),
        allowed=frozenset({INTERRUPTED, -sent.number}),
        may_leave=("out.h5", *SAVED),
        signals=(sent,),
        seconds=sent.delay,
        checks=(check.can_be_resumed("run.h5"), check.can_be_drawn("out.h5"), check.can_be_drawn("run.h5")),
    )


def too_large_for_disk(rng, seeds):
    """If a checkpoint does not fit on the disk, the previous one stays and the run continues."""
    block = 512  # unit of `ulimit -f` [bytes]
    blocks = rng.randrange(1 + 2 * len(seeds.files["run.h5"]) // block)
    return Case(
        description=f"files of at most {blocks} blocks",
        arguments=[*RESUME, *RESUMED],
        files=seeds.some(*RUN),
        shell=f"ulimit -f {blocks}",
        allowed=frozenset({DONE, FAILED}),
        outputs=("out.h5",),
        may_leave=SAVED,
        checks=(check.same_bytes({"out.h5": seeds.resumed}), check.can_be_resumed("run.h5")),
    )


def with_options(rng, seeds):
    chosen = some_choices(rng, seeds, ("resume",), most=2)
    arguments = [*RESUME, *limits_besides(chosen, time=str(TIME)), *chosen]
    return Case(
        description=" ".join(arguments),
        arguments=arguments,
        files=seeds.some(*RUN),
        allowed=REFUSED if is_refused(arguments) else ACCEPTED_OR_REFUSED,
        outputs=("out.h5",),
        may_leave=SAVED,
        memory=True,
        seconds=TIME,
        checks=(check.can_be_resumed("run.h5"), check.can_be_drawn("out.h5")),
    )


SCENARIOS = (damaged, ended_by_signal, damaged, sound, damaged, too_large_for_disk, ended_by_signal, with_options)


def checkpoints(rng, seeds, number):
    return SCENARIOS[number % len(SCENARIOS)](rng, seeds)

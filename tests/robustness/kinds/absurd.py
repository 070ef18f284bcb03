"""Saved runs and solutions with absurd numbers, and checksums that include them: refused, or read without harm."""

import json
import re
import struct
import zlib

from case import BAD_INPUT, DONE, Case
from seeds import RESUMED, RUN, SOLUTION, TINY

BLOCK, OWN = 4096, 9  # bytes of the table of checksums, and of its own checksum at the end
NUMBERS = {
    "<d": (float("nan"), float("inf"), -1.0, -1e300, 1e300, 1e-300, 0.0, -0.0, 5e-324, 2.0**62),
    "<f": (float("nan"), float("inf"), -1.0, -3e38, 3e38, 1e-45, 0.0, 2.0**31),
    "<q": (-1, -(2**63), 2**63 - 1, 2**62, 2**53, 2**40, 2**31, 0, 1),
    "<i": (-1, -(2**31), 2**31 - 1, 0, 1, 10**9),
    "<B": (2, 255, 128, 0, 1),
}
IN_TEXT = ("-1", "0", "1e300", "-1e300", "1e-300", "1e9", "null", "true", "[]", '""', "9" * 30, "-0", "0.5", "1e400")
USES = (
    ("resume", "run.h5", "-o", "out.h5", *RESUMED),
    ("resume", "run.h5", "-o", "out.h5", *RESUMED),
    ("resume", "run.h5", "-o", "out.h5", *RESUMED),
    ("info", "room.h5", "--json"),
    ("render", "room.h5", "-o", "out.exr", "--view", "room-0", *TINY),
    ("render", "room.h5", "-o", "out.exr", "--shading", "flat", "--eye", "1,1,1", "--look-at", "2,2,1", *TINY),
    ("probe", "room.h5", "--plane", "1", "--samples", "4"),
    ("export", "room.h5", "-o", "out.vtu"),
)


def crc(content):
    return f"{zlib.crc32(content):08x}".encode()


def ranges(content):
    """Returns name, begin and length of each part of the file."""
    table = content[: BLOCK - OWN].rstrip(b"\n").split(b"\n")[1:]
    parts = [line.split(b" ", 3) for line in table]
    return [(name.decode(), int(begin), int(length)) for _, begin, length, name in parts]


def arrays(content):
    """Returns begin and length of each array that is not empty, by name."""
    return {name: (begin, length) for name, begin, length in ranges(content) if name != "structure" and length > 0}


def with_checksums(content):
    table = content[:BLOCK].split(b"\n", 1)[0] + b"\n"
    for name, begin, length in ranges(content):
        table += b"%s %d %d %s\n" % (crc(content[begin : begin + length]), begin, length, name.encode())
    table = table.ljust(BLOCK - OWN, b"\n")
    return table + crc(table) + b"\n" + content[BLOCK:]


def with_number(rng, content, begin, length):
    form = rng.choice([form for form in NUMBERS if struct.calcsize(form) <= length])
    size = struct.calcsize(form)
    number = rng.choice(NUMBERS[form])
    at = begin + size * rng.randrange(length // size)
    return content[:at] + struct.pack(form, number) + content[at + size :], f"{form[1]} {number} at {at - begin}"


def with_filled(rng, content, begin, length):
    byte = rng.choice((0x00, 0x7F, 0x80, 0xFF))
    return content[:begin] + bytes([byte]) * length + content[begin + length :], f"all bytes {byte}"


def with_word(rng, content, begin, length):
    """Replaces a number of the description by a word of at most its length, and blanks."""
    text = content[begin : begin + length]
    numbers = [m for m in re.finditer(rb"(?<=[ ,:\[])-?\d[\d.e+-]*", text)]
    found = rng.choice(numbers)
    words = [word for word in IN_TEXT if len(word) <= len(found[0])]
    word = rng.choice(words)
    padded = word.encode().ljust(len(found[0]))
    context = text[max(0, found.start() - 30) : found.start()].decode(errors="replace").split("\n")[-1]
    return content[: begin + found.start()] + padded + content[begin + found.end() :], f"{context.strip()} {word}"


def array_of_state(rng, content):
    """Place of a non-empty array of the state."""
    parts = arrays(content)
    begin, length = parts["/state/index"]
    at, places = parts["/state/bytes"][0], []
    for name, size in json.loads(content[begin : begin + length])["arrays"]:
        places += [(name, at, size)] if size else []
        at += size
    return rng.choice(places)


def changed(rng, content):
    parts = arrays(content)
    if "/state/bytes" in parts and rng.random() < 0.7:
        name, begin, length = array_of_state(rng, content)
    else:
        name = rng.choice([name for name in parts if name != "/state/index"])
        begin, length = parts[name]
    if name == "/description":
        change = with_word
    else:
        change = with_filled if rng.random() < 0.25 else with_number
    content, how = change(rng, content, begin, length)
    return content, f"{name}: {how}"


def absurd(rng, seeds, _):
    words = rng.choice(USES)
    (file,) = RUN if words[0] == "resume" else SOLUTION
    content, how = changed(rng, seeds.files[file])
    if rng.random() < 0.3:
        content, more = changed(rng, content)
        how += f"; {more}"
    return Case(
        description=f"{words[0]}: {how}",
        arguments=list(words),
        files={file: with_checksums(content)},
        allowed=frozenset({DONE, BAD_INPUT}),
        outputs=tuple(word for word in words if word.startswith("out.")),
        may_leave=("run.h5", "run.previous.h5"),
        memory=True,
    )

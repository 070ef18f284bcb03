"""Damages the bytes of a file. All choices come from the random generator that is passed in."""

import re

NUMBERS = b"""0 -1 1 -0 .5 2 -3.7 0.999999 90 180 1000 1e5 1e9 1e14 1e-6 0.0000001 1e38 -1e38 1e39 1e400 -1e400 1e-45 1e-400
    nan inf -inf 2147483648 4294967296 18446744073709551616 0x10 1e .""".split()
NUMBERS += [b"9" * 400]
CONTROL = [b"\0", b"\x1b[31m", b"\x07", b"\r", b"\x7f", b"\xff\xfe", b"\xc3\x28", b"\xef\xbb\xbf", b"\x0b"]
CONTROL += [b"\\\n", b"\t\t", b'"', b"#"]
HEADER = 400  # bytes
NUMBER = re.compile(rb"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
WORD = re.compile(rb"[^\s,]+")


def place(rng, data):
    """Returns a position, half of the time in the header, which is short but has the most structure."""
    return rng.randrange(rng.choice((min(len(data), HEADER), len(data))))


def span(rng, data, longest):
    start = place(rng, data)
    return start, min(len(data), start + rng.randint(1, longest))


def splice(data, start, end, content):
    return data[:start] + content + data[end:]


# ---- any file


def flip_bits(rng, data):
    changed = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 8))):
        changed[place(rng, data)] ^= 1 << rng.randrange(8)
    return bytes(changed)


def flip_byte(rng, data):
    at = place(rng, data)
    return splice(data, at, at + 1, bytes([rng.randrange(256)]))


def zero_range(rng, data):
    start, end = span(rng, data, rng.choice((4, 64, 4096)))
    return splice(data, start, end, bytes(end - start))


def randomise_range(rng, data):
    start, end = span(rng, data, rng.choice((4, 64, 1024)))
    return splice(data, start, end, rng.randbytes(end - start))


def extreme_integer(rng, data):
    size = rng.choice((2, 4, 8))
    at = place(rng, data)
    value = rng.choice((0, 1, (1 << 8 * size) - 1, 1 << 8 * size - 1, (1 << 8 * size - 1) - 1))
    return splice(data, at, at + size, value.to_bytes(size, rng.choice(("little", "big"))))


def delete_range(rng, data):
    return splice(data, *span(rng, data, rng.choice((1, 16, 1024))), b"")


def duplicate_range(rng, data):
    start, end = span(rng, data, rng.choice((1, 16, 1024)))
    return splice(data, end, end, data[start:end] * rng.choice((1, 1, 50)))


def swap_blocks(rng, data):
    size = rng.choice((8, 64, 512))
    a, b = sorted(rng.randrange(max(1, len(data) - size)) for _ in range(2))
    if b < a + size:
        return data
    return data[:a] + data[b : b + size] + data[a + size : b] + data[a : a + size] + data[b + size :]


def truncate(rng, data):
    return data[: rng.choice((0, 1, 8, len(data) - 1, rng.randrange(len(data) + 1), rng.randrange(len(data) + 1)))]


def append(rng, data):
    return data + rng.choice((b"\0", b"\n", bytes(4096), rng.randbytes(100), data))


# ---- text


def substitute_number(rng, data):
    numbers = list(NUMBER.finditer(data))
    return splice(data, *rng.choice(numbers).span(), rng.choice(NUMBERS)) if numbers else data


def swap_words(rng, data):
    words = list(WORD.finditer(data))
    if len(words) < 2:
        return data
    a, b = sorted(rng.sample(range(len(words)), 2))
    (a_start, a_end), (b_start, b_end) = words[a].span(), words[b].span()
    return data[:a_start] + words[b][0] + data[a_end:b_start] + words[a][0] + data[b_end:]


def copy_word(rng, data):
    words = list(WORD.finditer(data))
    return splice(data, *rng.choice(words).span(), rng.choice(words)[0]) if words else data


def lengthen_word(rng, data):
    words = list(WORD.finditer(data))
    return splice(data, *rng.choice(words).span(), rng.choice(words)[0] * rng.choice((2, 100, 20000))) if words else data


def shuffle_lines(rng, data):
    lines = data.splitlines(keepends=True)
    start, end = span(rng, lines, 8)
    block = lines[start:end]
    rng.shuffle(block)
    return b"".join(lines[:start] + block + lines[end:])


def insert_control(rng, data):
    at = rng.randrange(len(data) + 1)
    return splice(data, at, at, rng.choice(CONTROL))


def nest(rng, data):
    """Inserts brackets nested deeper than the stack of any recursive parser."""
    opening, closing = rng.choice(((b"[", b"]"), (b'{"a":', b"}")))
    depth = rng.choice((100, 100_000))
    at = rng.randrange(len(data) + 1)
    return splice(data, at, at, opening * depth + closing * rng.choice((0, depth)))


BINARY = (flip_bits, flip_byte, zero_range, randomise_range, extreme_integer)
BINARY += (delete_range, duplicate_range, swap_blocks, truncate, append)
TEXT = (flip_bits, delete_range, duplicate_range, truncate, *[substitute_number] * 10)
TEXT += (swap_words, copy_word, copy_word, lengthen_word, shuffle_lines, insert_control)
JSON = (*TEXT, nest)


def mutated(rng, data, mutators, most):
    """@return the mutated `data`, always different from it, and the names of the mutators."""
    changed = data
    while changed == data:
        chosen = rng.choices(mutators, k=rng.choice((1, 1, rng.randint(1, most))))
        for mutator in chosen:
            changed = mutator(rng, changed) if changed else changed
    return changed, "+".join(mutator.__name__ for mutator in chosen)

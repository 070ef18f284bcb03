"""Reads Radiance's pictures (.pic, .hdr): RGBE in scan lines from the top, with the run-length encoding of each channel."""

from pathlib import Path

import numpy as np

EXPONENT_BIAS = 128 + 8  # of a mantissa that is an integer of 8 bits


def read_pic(path: Path) -> np.ndarray:
    """Returns height x width x RGB."""
    data = path.read_bytes()
    begin = data.index(b"\n\n") + 2
    end = data.index(b"\n", begin)
    words = data[begin:end].split()
    if words[0] != b"-Y" or words[2] != b"+X":
        raise ValueError(f"{path}: resolution line {data[begin:end]!r}, expected -Y height +X width")
    height, width = int(words[1]), int(words[3])
    texels, position = np.empty((height, width, 4), np.uint8), end + 1
    for line in texels:
        position = _read_line(data, position, line)
    exponents = texels[:, :, 3:].astype(int)
    return np.where(exponents > 0, np.ldexp(texels[:, :, :3] + 0.5, exponents - EXPONENT_BIAS), 0)


def _read_line(data: bytes, position: int, line: np.ndarray) -> int:
    """Decodes one scan line into `line` and returns the position after it."""
    width = len(line)
    is_encoded = data[position : position + 4] == bytes([2, 2, width >> 8, width & 255])
    if not is_encoded:
        line[:] = np.frombuffer(data, np.uint8, 4 * width, position).reshape(width, 4)
        return position + 4 * width
    position += 4
    for channel in range(4):
        column = 0
        while column < width:
            count = data[position]
            if count > 128:  # a run of one value
                count -= 128
                line[column : column + count, channel] = data[position + 1]
                position += 2
            else:
                line[column : column + count, channel] = np.frombuffer(data, np.uint8, count, position + 1)
                position += 1 + count
            column += count
    return position

"""Reads the OpenEXR pictures of `interflect render`."""

import struct
import zlib
from pathlib import Path

import numpy as np

LINES_PER_BLOCK = 16  # with ZIP compression
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # linear Rec. 709


def read_exr(path: Path, layer: str = "") -> np.ndarray:
    """Returns height x width x RGB of a layer such as "emitted" (default: the picture itself)."""
    return read_layer(path, layer, "RGB")


def read_layer(path: Path, layer: str, letters: str) -> np.ndarray:
    """Returns height x width x channels of a layer, whose channels have these letters. Reads only the files of this
    program: 32 bit floats, scan lines, ZIP."""
    data = path.read_bytes()
    attributes, position = {}, 8
    while data[position]:
        name, kind, rest = data[position : position + 4096].split(b"\0", 2)
        (size,) = struct.unpack("<i", rest[:4])
        begin = position + len(name) + len(kind) + 6
        attributes[name.decode()] = data[begin : begin + size]
        position = begin + size
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    channels = _channel_names(attributes["channels"])
    wanted = [channels.index(f"{layer}.{c}" if layer else c) for c in letters]
    picture = np.empty((height, width, len(letters)))
    blocks = -(-height // LINES_PER_BLOCK)
    for offset in struct.unpack_from(f"<{blocks}q", data, position + 1):
        line, size = struct.unpack_from("<2i", data, offset)
        lines = min(LINES_PER_BLOCK, height - (line - top))
        raw = _unzipped(data[offset + 8 : offset + 8 + size], lines * len(channels) * width * 4)
        block = np.frombuffer(raw, "<f4").reshape(lines, len(channels), width)
        picture[line - top : line - top + lines] = block[:, wanted].transpose(0, 2, 1)
    return picture


def _channel_names(attribute: bytes) -> list[str]:
    description_size, names = 16, []
    while attribute[0]:
        name, rest = attribute.split(b"\0", 1)
        names.append(name.decode())
        attribute = rest[description_size:]
    return names


def _unzipped(packed: bytes, size: int) -> bytes:
    """Undoes OpenEXR's ZIP: deflate, differences of bytes, and the even bytes before the odd ones."""
    if len(packed) == size:
        return packed
    differences = np.frombuffer(zlib.decompress(packed), np.uint8).astype(np.int64)
    differences[1:] -= 128
    values = np.cumsum(differences).astype(np.uint8)
    raw = np.empty(size, np.uint8)
    half = (size + 1) // 2
    raw[0::2], raw[1::2] = values[:half], values[half:]
    return raw.tobytes()


def noise_floor(picture: Path, error: Path) -> float:
    """Returns the relative MSE (docs/method/metrics.md) due to noise alone; `error` is the picture's standard error."""
    wanted, deviation = read_exr(picture), read_exr(error)
    mean = luminance(wanted).mean()
    return float(np.mean(deviation**2 / (wanted**2 + (0.01 * mean) ** 2)))


def luminance(picture: np.ndarray) -> np.ndarray:
    return picture @ LUMINANCE

# SPDX-License-Identifier: Apache-2.0
"""Arrays as pictures: a PNG writer in twenty lines, and colours."""

import struct
import zlib
from pathlib import Path

import numpy as np

RAMP = np.array([[38, 24, 74], [59, 82, 139], [33, 144, 140], [94, 201, 98], [253, 231, 37]])


def colours(values, low=None, high=None, empty=255):
    """Numbers as colours, dark blue to yellow, (..., 3) in 0 ... 255; NaN and inf as `empty`."""
    finite = np.isfinite(values)
    some = values[finite] if finite.any() else np.zeros(1)
    low, high = some.min() if low is None else low, some.max() if high is None else high
    scaled = np.clip((np.where(finite, values, low) - low) / ((high - low) or 1), 0, 1)
    steps = np.linspace(0, 1, len(RAMP))
    rgb = np.stack([np.interp(scaled, steps, RAMP[:, i]) for i in range(3)], axis=-1)
    return np.where(finite[..., None], rgb, np.asarray(empty, float))


def light(normals, direction=(-0.4, -0.6, 0.7)):
    """How bright surfaces are in the light that comes from a direction: 0.15 ... 1."""
    unit = np.array(direction) / np.linalg.norm(direction)
    return 0.15 + 0.85 * np.clip(0.5 + 0.5 * (normals @ unit), 0, 1)


def png(rgb):
    """(height, width, 3) or (height, width) numbers of 0 ... 255 as the bytes of a PNG.

    In 64 steps a channel, which keeps files small.
    """
    pixels = (np.clip(rgb, 0, 255) / 255 * 63).round().astype(np.uint8) * 4
    pixels += pixels >> 6
    height, width = pixels.shape[:2]
    kind = 2 if pixels.ndim == 3 else 0
    rows = pixels.reshape(height, -1)
    filtered = np.concatenate([np.full((height, 1), 2, np.uint8),  # each row less the one above
                               np.diff(rows, axis=0, prepend=np.uint8(0))], axis=1)

    def chunk(name, data):
        body = name + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    header = struct.pack(">2I5B", width, height, 8, kind, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
            + chunk(b"IDAT", zlib.compress(filtered.tobytes(), 9)) + chunk(b"IEND", b""))


def save(path, rgb):
    """Writes a PNG."""
    Path(path).write_bytes(png(rgb))


class Picture:
    """What a notebook shows as a picture."""

    def __init__(self, rgb):
        self.rgb = rgb

    def _repr_png_(self):
        return png(self.rgb)

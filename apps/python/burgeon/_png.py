"""Pictures of numbers as PNG: grey of 8 bits and colours of three bytes, for readers of labels that need these."""

from __future__ import annotations

import struct
import zlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

GREY, COLOUR = 0, 2
"""Colour types of PNG."""


def png_of(pixels: "np.ndarray") -> bytes:
    """Returns the lossless file of (height, width) or (height, width, 3) uint8."""
    import numpy as np

    height, width = pixels.shape[:2]
    kind = GREY if pixels.ndim == 2 else COLOUR
    rows = np.ascontiguousarray(pixels, np.uint8).reshape(height, -1)
    # Each row begins with the number of its filter: 0, none.
    filtered = np.concatenate([np.zeros((height, 1), np.uint8), rows], axis=1)
    header = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(filtered.tobytes(), 6)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(name, data) for name, data in chunks)


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

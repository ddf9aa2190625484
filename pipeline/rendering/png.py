"""Pictures as PNG files, with one filter for all rows: Pillow tries five on each, which takes three times as long as the rest and saves 3 %."""

import struct
import zlib

import numpy as np
from PIL import Image

UP = 2  # the filter: a byte less the one above it; most of a plan goes on as the row before did
LEVEL = 2  # of zlib: a tenth larger than at most, in a tenth of the time


def png(image: Image.Image) -> bytes:
    """Encode an RGB image."""
    width, height = image.size
    flat = np.asarray(image.convert("RGB")).reshape(height, 3 * width)
    rows = np.empty((height, 1 + 3 * width), np.uint8)
    rows[:, 0] = UP
    rows[0, 1:] = flat[0]
    np.subtract(flat[1:], flat[:-1], out=rows[1:, 1:])
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)  # 8 bits, RGB
    parts = ((b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), LEVEL)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(map(_chunk, *zip(*parts, strict=True)))


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

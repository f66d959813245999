"""Creates the images that `tests/codec.rs` reads: 16x12 pixels, quarters red, green, blue and yellow.

    python make.py     (needs pillow and numpy)

What the Rust encoders can write is made in the test itself; these are the variants they cannot.
"""

import io
import pathlib
import struct
import zlib

import numpy as np
from PIL import Image

HERE = pathlib.Path(__file__).resolve().parent
RED, GREEN, BLUE, YELLOW = (200, 30, 40), (20, 180, 60), (30, 50, 190), (220, 210, 20)


def quarters():
    picture = np.empty((12, 16, 3), np.uint8)
    picture[:6, :8], picture[:6, 8:], picture[6:, :8], picture[6:, 8:] = RED, GREEN, BLUE, YELLOW
    return picture


def write(name, data):
    (HERE / name).write_bytes(data)


def saved(image, **options):
    out = io.BytesIO()
    image.save(out, **options)
    return out.getvalue()


def png(width, height, depth, colour, interlaced, rows, *chunks):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, interlaced)
    body = chunk(b"IHDR", header) + b"".join(chunk(*c) for c in chunks)
    return b"\x89PNG\r\n\x1a\n" + body + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def adam7(picture):
    rows = b""
    for x, y, dx, dy in [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]:
        for row in picture[y::dy, x::dx]:
            rows += b"\0" + row.tobytes() if row.size else b""
    return rows


def main():
    picture = quarters()
    image = Image.fromarray(picture)
    jpeg = {"format": "JPEG", "quality": 90, "subsampling": 0, "optimize": True}
    write("progressive.jpg", saved(image, progressive=True, **jpeg))
    cmyk = Image.merge("CMYK", [*(Image.fromarray(255 - picture[..., c]) for c in range(3)), Image.new("L", image.size, 0)])
    write("cmyk.jpg", saved(cmyk, **jpeg))
    # Pillow inverts the four planes and marks them as CMYK; inverted luma and chroma are YCCK's of inverted colours.
    ink = Image.merge("CMYK", [*image.convert("YCbCr").split(), Image.new("L", image.size, 0)])
    data = bytearray(saved(ink, **jpeg))
    data[data.index(b"Adobe") + 11] = 2
    write("ycck.jpg", bytes(data))
    palette = image.quantize(4)
    write("palette.png", saved(palette, format="PNG", optimize=True))
    write("interlaced.png", png(16, 12, 8, 2, 1, adam7(picture)))
    deep = (picture.astype(int) << 8 | 0x5A).astype(">u2")
    write("deep.png", png(16, 12, 16, 2, 0, b"".join(b"\0" + row.tobytes() for row in deep)))
    write("deep_grey.png", png(16, 12, 16, 0, 0, b"".join(b"\0" + row[:, :1].tobytes() for row in deep)))
    two = np.concatenate([picture[..., :1], 255 - picture[..., :1]], -1)
    write("grey_alpha.png", png(16, 12, 8, 4, 0, b"".join(b"\0" + row.tobytes() for row in two)))
    write("lossy.webp", saved(image, format="WEBP", quality=95))
    write("palette.bmp", saved(palette, format="BMP"))


main()

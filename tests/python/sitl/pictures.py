"""Pictures of the book: each is made anew by what made it, and compared. RECORD_PICTURES=1 writes those that are made into the book."""

import os
from pathlib import Path

import numpy as np
from PIL import Image

IMAGES = Path(__file__).resolve().parents[3] / "book" / "src" / "images"
#: Side of the squares whose mean brightness is compared, so that a line may move by a pixel.
SQUARE = 10


def brightness(file: Path) -> np.ndarray:
    """Mean brightness of squares, 0 to 255."""
    with Image.open(file) as image:
        pixels = np.asarray(image.convert("L"), dtype=float)
    rows, columns = (length // SQUARE for length in pixels.shape)
    return pixels[: rows * SQUARE, : columns * SQUARE].reshape(rows, SQUARE, columns, SQUARE).mean(axis=(1, 3))


def difference(one: Path, other: Path) -> float:
    """Share of the drawn squares that look different."""
    a, b = brightness(one), brightness(other)
    if a.shape != b.shape:
        return 1.0
    drawn = (a < 250) | (b < 250)
    return float((np.abs(a - b)[drawn] > 25).mean())


def check(made: Path, name: str, most: float) -> None:
    """That a picture of the book looks as it is made now, but for a share of what is drawn."""
    if os.environ.get("RECORD_PICTURES"):
        with Image.open(made) as drawn:
            drawn.convert("RGB").quantize(128).save(IMAGES / name, optimize=True)
    differs = difference(made, IMAGES / name)
    assert differs < most, f"{100 * differs:.1f} % of {name} looks different: look at {made}; RECORD_PICTURES=1 keeps it"

"""Line drawings of plants, as a person would draw them on a sheet."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, List, NamedTuple

from . import _burgeon
from ._files import write_whole
from ._given import wrong
from .model import array

if TYPE_CHECKING:
    import numpy as np

__all__ = ["Drawing", "Line"]


class Line(NamedTuple):
    """A stroke of a drawing."""

    kind: str
    """``axis``, ``stalk`` (of thin organs), ``blade`` or ``crown``."""
    points: "np.ndarray"
    """(n, 2) float64: metres, x to the right, y upwards; the plant stands at the origin."""
    row: int
    """Row of ``plant.axes`` or of ``plant.organs``; -1 for a crown."""


class Drawing(NamedTuple):
    """The lines of a drawing in the order of drawing: wood and stems, then leaves and petals from behind."""

    name: str
    lines: "List[Line]"

    def to_svg(self) -> bytes:
        """Returns the file; each line lies on the layer of its kind."""
        return _burgeon.drawing_svg(self.name, [(line.kind, line.points.tolist()) for line in self.lines])

    def save(self, path: "str | os.PathLike[str]") -> None:
        """Writes ``.svg``, completely or not at all."""
        folder, name = os.path.split(os.fspath(path))
        if not name.lower().endswith(".svg"):
            raise wrong(f"drawings are written as .svg, not {name!r}", "path", name, "a name that ends with .svg")
        write_whole(folder, [(name, self.to_svg())])


def draw(raw: "_burgeon.RawPlant") -> Drawing:
    """Draws a plant of the core from the front, as a line drawing (``burgeon grow --drawing``).

    Stems and branches are lines along their middle, thick wood is a line along both its edges. Visible organs are outlines; in a
    plant with many of them, the drawing has the trunk, the limbs that foliage does not hide, and the outline of the crown around
    the foliage.
    """
    lines = raw.drawing()
    return Drawing(raw.name, [Line(kind, array(points), row) for kind, points, row in lines])

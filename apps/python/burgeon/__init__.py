"""Three-dimensional plants: drawn, grown, measured, in flower.

>>> import burgeon as bg
>>> oak = bg.grow("oak", seed=2, age=6, detail=0.2)
>>> oak.nodes.position.shape[1], oak.measures()["height_m"] > 0
(3, True)

``grow``, ``sketch``, ``leaf``, ``bloom`` and ``scan`` make a ``Plant``; its tables are NumPy arrays, ``plant.model`` its meshes,
``plant.cloud()`` its points as a scanner measures them. ``burgeon.dataset`` makes thousands; ``burgeon.forest`` has stands of up
to millions of trees. Lengths are metres, +y is up; the same spec and seed give the same bits on every machine and as the command
line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._burgeon import VERSION as __version__
from ._burgeon import set_threads
from ._light import Light
from .camera import Camera
from .errors import BudgetError, BurgeonError, SpecError
from .law import Law
from .makers import bloom, grow, leaf, open, presets, scan, schema, sketch
from .model import Cloud, Masks, Model, Part
from .plant import PARTS, Axes, Nodes, Organs, Plant

if TYPE_CHECKING:
    from . import dataset, forest, labels
    from ._grove import Grove, GroveCloud, GroveMasks, grove, scene

__all__ = [
    "PARTS",
    "Axes",
    "BudgetError",
    "BurgeonError",
    "Camera",
    "Cloud",
    "Grove",
    "GroveCloud",
    "GroveMasks",
    "Law",
    "Light",
    "Masks",
    "Model",
    "Nodes",
    "Organs",
    "Part",
    "Plant",
    "SpecError",
    "__version__",
    "bloom",
    "dataset",
    "forest",
    "grove",
    "grow",
    "labels",
    "leaf",
    "open",
    "presets",
    "scan",
    "scene",
    "schema",
    "set_threads",
    "sketch",
]


def __getattr__(name: str) -> Any:
    # Imported on first use, because they import more.
    if name in ("dataset", "forest", "labels"):
        import importlib

        return importlib.import_module(f".{name}", __name__)
    if name in ("Grove", "GroveCloud", "GroveMasks", "grove", "scene"):
        import importlib

        found = getattr(importlib.import_module("._grove", __name__), name)
        globals()[name] = found
        return found
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

"""Checks of arguments before they cross into the core: errors name the argument, its value, and the valid range."""

from __future__ import annotations

import math
import operator
import os
from typing import TYPE_CHECKING, Any, Dict, Iterable, Mapping, Tuple

from . import _burgeon
from .errors import SpecError

if TYPE_CHECKING:
    import numpy as np

ENDLESS = float("inf")
FORMATS = {word: (kind, frozenset(rooms)) for kind, word, _, rooms in _burgeon.formats()}
"""Kind of each written format of models and of structure, and the contents for which its files have room."""
STRUCTURES = tuple(word for word, (kind, _) in FORMATS.items() if kind == "structure")
"""Formats of the structure of plants."""


def holds(word: str, room: str) -> bool:
    """Returns whether files of a format have room for a kind of content."""
    return room in FORMATS.get(word, ("", ()))[1]


def whole(name: str, value: Any, least: int, most: int) -> int:
    """Returns a whole number within its range, also from NumPy."""
    try:
        # True is not a number.
        if isinstance(value, bool):
            raise TypeError
        number = operator.index(value)
    except TypeError:
        bounds = f"a whole number, {least} to {most}"
        if isinstance(value, float):
            raise beyond(name, f"{value:.17g}", bounds) from None
        raise TypeError(f"{name} must be {bounds}, not {value!r}") from None
    if not least <= number <= most:
        raise beyond(name, str(number), f"{least} to {most}")
    return number


def beyond(name: str, value: Any, bounds: str) -> SpecError:
    """Returns the error for an argument out of its range, with the message of the core."""
    return wrong(f"{name} must be {bounds}, not {value}", name, value, bounds)


def wrong(message: str, name: str, value: Any, bounds: str) -> SpecError:
    """Returns the same error with a message of its own."""
    return SpecError(message, "field-range", {"field": name, "value": str(value), "range": bounds})


def number(name: str, value: Any, least: float = -ENDLESS, most: float = ENDLESS, unit: str = "") -> float:
    """Returns a finite number within its range, also from NumPy."""
    bounds = "" if math.isinf(least) else f"{least:g} to {most:g} {unit}".rstrip()
    if isinstance(value, (bool, str, bytes)) or not hasattr(value, "__float__") or getattr(value, "shape", ()) != ():
        raise TypeError(f"{name} must be a number{', ' + bounds if bounds else ''}, not {value!r}")
    try:
        real = float(value)
    except OverflowError:
        real = ENDLESS
    if not math.isfinite(real) or not least <= real <= most:
        raise beyond(name, f"{real:.17g}" if isinstance(value, float) else str(value), bounds or "a finite number")
    return real


def flag(name: str, value: Any) -> bool:
    """Returns True or False, also from NumPy."""
    if isinstance(value, bool) or type(value).__name__ in ("bool_", "bool"):
        return bool(value)
    raise TypeError(f"{name} must be True or False, not {value!r}")


def word(name: str, value: Any) -> str:
    """Returns a text. The core checks whether it is a known word."""
    if isinstance(value, str):
        return value
    raise TypeError(f"{name} must be a text, not {value!r}")


def table(name: str, value: Any) -> "Dict[str, Any]":
    """Returns a dict with texts as its keys; an empty one for None."""
    if value is None:
        return {}
    if not isinstance(value, Mapping) or not all(isinstance(key, str) for key in value):
        raise TypeError(f"{name} must be a dict of names and values, not {value!r}")
    return dict(value)


def points(scan: Any, name: str = "scan") -> "np.ndarray":
    """Returns the points of a scan as (n, 3) float64."""
    import numpy as np

    array = np.asarray(scan)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"a scan is numbers, not {array.dtype}")
    if array.ndim != 2 or array.shape[1] != 3:
        raise wrong(f"a scan must be of shape (points, 3), not {array.shape}", name, array.shape, "of shape (points, 3)")
    array = np.ascontiguousarray(array, np.float64)
    if not np.isfinite(array).all():
        row = int(np.argmin(np.isfinite(array).all(axis=1)))
        raise beyond(f"{name}[{row}]", array[row].tolist(), "finite")
    return array


def coloured(scan: Any, name: str = "scan") -> "Tuple[np.ndarray, bytes]":
    """Returns the points of a scan as (n, 3) float64 and, from an array with red, green and blue (0 to 255) after them, those as
    bytes."""
    import numpy as np

    array = np.asarray(scan)
    if array.ndim != 2 or array.shape[1] != 6:
        return points(array, name), b""
    colors = array[:, 3:]
    if not ((colors >= 0) & (colors <= 255)).all():
        row = int(np.argmin(((colors >= 0) & (colors <= 255)).all(axis=1)))
        raise wrong(f"{name}[{row}]: a colour is red, green and blue", f"{name}[{row}]", colors[row].tolist(), "each 0 to 255")
    return points(array[:, :3], name), np.ascontiguousarray(np.rint(colors), np.uint8).tobytes()


def unused(name: str, value: Any, needs: str) -> SpecError:
    """Returns the error for an argument that would change nothing; `needs` says where it applies."""
    return wrong(f"{name} {needs}", name, value, "left out")


def axes(extension: str, unit: str, up: "str | None") -> None:
    """Fails on a unit or an axis if the format has its own."""
    if extension == "burgeon" or (extension in FORMATS and not holds(extension, "axes")):
        for name, value, own in (("unit", unit, "m"), ("up", up or "y", "y")):
            if word(name, value) != own:
                raise unused(name, value, f"is of files that do not fix it: .{extension} is in metres, +Y up")


def path(name: str, value: Any) -> str:
    """Returns a path. A number is refused: as a path it would mean an open file."""
    if isinstance(value, (str, os.PathLike)):
        return os.fsdecode(value)
    raise TypeError(f"{name} must be a path, not {value!r}")


def keys(name: str, given: "Mapping[str, Any]", known: "Iterable[str]") -> None:
    """Fails on an unknown key, and names the one that is probably meant."""
    known = list(known)
    for key in given:
        if key not in known:
            fields = {"path": name, "name": str(key), "choices": ", ".join(known)}
            meant = _burgeon.meant(str(key), known)
            raise SpecError(f"{name} has no {key!r}, it has {fields['choices']}{meant}", "spec-unknown", fields)


def asked_of(seed: int, budget: float, fields: "Mapping[str, Any]", skin: "Mapping[str, Any]") -> "Dict[str, Any]":
    """Returns a maker's request for the core; in ``skin``, None stands for a missing field."""
    if isinstance(seed, bool) or not hasattr(seed, "__index__") or not 0 <= seed < 2**64:
        raise beyond("seed", repr(seed), "a whole number, 0 to 2^64 - 1")
    return {
        "seed": int(seed),
        "budget": number("budget", budget, 1, 1000),
        "fields": dict(fields),
        "skin": {name: value for name, value in skin.items() if value is not None},
    }

"""Light on plants: absorption of each axis and organ (``burgeon light``)."""

from __future__ import annotations

import datetime
import json
from typing import TYPE_CHECKING, Any, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

from ._given import beyond, flag, number, unused, whole, word, wrong
from .model import array

if TYPE_CHECKING:
    import numpy as np
    from typing_extensions import Literal, TypedDict

    class Lighting(TypedDict, total=False):
        """Sources of light, and reflectances of surfaces."""

        sky: Literal["overcast", "uniform", "clear"]
        diffuse: float
        direct: float
        sun: Tuple[float, float]
        place: Sequence[float]
        date: "Day"
        hour: float
        zone: float
        turbidity: float
        daily: bool
        sky_table: Any
        repeat: Tuple[float, float]
        leaf: Tuple[float, float]
        wood: float
        soil: float
        bounces: int
        rays: int


__all__ = ["Light", "lit"]

SKIES = ("overcast", "uniform", "clear")
"""Distributions of the light of a sky."""
ROWS_MOST = 2000
"""Most rows of a measured sky."""

Day = Union[str, datetime.date, Sequence[int]]


class Light(NamedTuple):
    """Light on plants: a row for each axis and organ with a surface, as in the table of ``burgeon light``."""

    plant: "np.ndarray"
    """(n,) uint32: number of the plant, from 0: row of ``grove.places``."""
    part: "np.ndarray"
    """(n,) uint8: row of ``burgeon.PARTS``."""
    row: "np.ndarray"
    """(n,) int32: row of the plant's ``organs`` or, for an axis, of its ``axes``; -1 for neither."""
    axis: "np.ndarray"
    """(n,) int32: the axis itself or the one that bears the organ; -1 for none."""
    order: "np.ndarray"
    """(n,) uint32: branching order of that axis."""
    area: "np.ndarray"
    """(n,) float64: one side of its mesh, m2."""
    height: "np.ndarray"
    """(n,) float64: height of its centre, metres."""
    incident: "np.ndarray"
    """(n,) float64: light on both sides, for each square metre of one side: W/m2, for a day MJ/m2."""
    absorbed: "np.ndarray"
    """(n,) float64: absorbed part of it."""
    fapar: "np.ndarray"
    """(n,) float64: ``absorbed`` over the light on a horizontal surface above the plants."""
    sunlit: "np.ndarray"
    """(n,) float64: the share of its area that is in the sun; NaN without a sun."""
    lines: "np.ndarray"
    """(n,) float64: number of lines of light that cross it: the relative error of figures is about one over its square root."""
    figures: "Dict[str, Any]"
    """Totals: ``unit``, ``incoming_per_m2``, ``absorbed``, ``leaf_absorbed``, ``leaf_area_m2``, ``sunlit``; for a stand that
    repeats itself also ``fapar``, ``leaf_area_index``, ``extinction``, ``balance``; None for totals that do not apply."""
    warnings: "List[str]"
    """Warnings of the computation."""

    def to_dict(self) -> "Dict[str, np.ndarray]":
        """Returns all columns by name, for ``pandas.DataFrame`` and the like."""
        return {name: getattr(self, name) for name in COLUMNS}


COLUMNS = Light._fields[:-2]
"""Columns with a number for each axis and organ."""


def _pair(name: str, given: Any, count: int, what: str) -> "List[float]":
    if isinstance(given, (str, bytes)) or not hasattr(given, "__len__") or len(given) != count:
        raise beyond(name, repr(given), what)
    return [number(f"{name}[{k}]", value) for k, value in enumerate(given)]


def _within(name: str, given: Any, least: float, most: float, unit: str = "") -> "Optional[float]":
    return None if given is None else number(name, given, least, most, unit)


def _date(day: Day) -> "List[int]":
    if isinstance(day, str):
        try:
            day = datetime.date.fromisoformat(day)
        except ValueError:
            raise beyond("date", repr(day), "a day such as 2026-06-21") from None
    parts = (day.year, day.month, day.day) if isinstance(day, datetime.date) else tuple(day)
    if len(parts) != 3:
        raise beyond("date", repr(day), "a day such as 2026-06-21")
    most = (2050, 12, 31)
    return [whole("date", part, least, top) for part, least, top in zip(parts, (1950, 1, 1), most)]


def _place(place: "Sequence[float]") -> "List[float]":
    given = [*place, 0.0] if hasattr(place, "__len__") and len(place) == 2 else place
    latitude, longitude, altitude = _pair("place", given, 3, "latitude and longitude, and metres above the sea")
    return [
        number("place[0]", latitude, -90, 90, "deg"),
        number("place[1]", longitude, -180, 180, "deg"),
        number("place[2]", altitude, -500, 9000, "m"),
    ]


def _cell(repeat: Any) -> "List[float]":
    sides = _pair("repeat", repeat, 2, "width and depth in metres")
    return [number(f"repeat[{k}]", side, 0.001, 10_000, "m") for k, side in enumerate(sides)]


def _optics(leaf: Any) -> "List[float]":
    shares = _pair("leaf", leaf, 2, "reflectance and transmittance")
    if min(shares) < 0 or sum(shares) > 1:
        raise beyond("leaf", repr(leaf), "reflectance and transmittance, together at most 1")
    return shares


def _sky_table(rows: Any) -> "List[List[float]]":
    import numpy as np

    table = np.asarray(rows, np.float64)
    if table.ndim != 2 or table.shape[1] != 3 or not 1 <= len(table) <= ROWS_MOST:
        bounds = f"1 to {ROWS_MOST} rows of azimuth, elevation (degrees) and W/m2 on a horizontal surface"
        raise beyond("sky_table", f"of shape {table.shape}", bounds)
    return table.tolist()


def lit(
    raw: Any,
    sky: "Optional[str]" = None,
    diffuse: "Optional[float]" = None,
    direct: "Optional[float]" = None,
    sun: "Optional[Tuple[float, float]]" = None,
    place: "Optional[Sequence[float]]" = None,
    date: "Optional[Day]" = None,
    hour: "Optional[float]" = None,
    zone: "Optional[float]" = None,
    turbidity: "Optional[float]" = None,
    daily: bool = False,
    sky_table: "Optional[Any]" = None,
    repeat: "Optional[Tuple[float, float]]" = None,
    leaf: "Optional[Tuple[float, float]]" = None,
    wood: "Optional[float]" = None,
    soil: "Optional[float]" = None,
    bounces: "Optional[int]" = None,
    rays: "Optional[int]" = None,
) -> Light:
    """Computes light on a plant or grove of the core: see ``Plant.light``."""
    daily = flag("daily", daily)
    value: Any
    if (place is None) != (date is None):
        raise wrong("place and date go together", "place" if place is None else "date", None, "both or none")
    if place is None:
        for name, value in (("hour", hour), ("zone", zone), ("turbidity", turbidity), ("daily", daily or None)):
            if value is not None:
                raise unused(name, value, "is of the sun of a place: give place and date")
    elif sun is not None:
        raise unused("sun", sun, "stands where the place has it")
    if daily or turbidity is not None:
        for name, value in (("direct", direct), ("diffuse", diffuse), ("hour", hour if daily else None)):
            if value is not None:
                raise unused(name, value, "is not of a clear day, which daily and turbidity ask for")
    if sky_table is not None:
        for name, value in (("sky", sky), ("diffuse", diffuse), ("direct", direct), ("sun", sun), ("place", place)):
            if value is not None:
                raise unused(name, value, "is in the table of the sky")
    if sky is not None and word("sky", sky) not in SKIES:
        raise beyond("sky", repr(sky), f"one of {', '.join(SKIES)}")
    asked = {
        "sky": sky,
        "diffuse": _within("diffuse", diffuse, 0, 2000, "W/m2"),
        "direct": _within("direct", direct, 0, 2000, "W/m2"),
        "sun": None if sun is None else _pair("sun", sun, 2, "azimuth and elevation in degrees"),
        "place": None if place is None else _place(place),
        "date": None if date is None else _date(date),
        "hour": _within("hour", hour, 0, 24, "h"),
        "zone": _within("zone", zone, -12, 14, "h"),
        "turbidity": _within("turbidity", turbidity, 1, 10),
        "daily": daily,
        "sky_table": None if sky_table is None else _sky_table(sky_table),
        "repeat": None if repeat is None else _cell(repeat),
        "leaf": None if leaf is None else _optics(leaf),
        "wood": _within("wood", wood, 0, 1),
        "soil": _within("soil", soil, 0, 1),
        "bounces": None if bounces is None else whole("bounces", bounces, 0, 50),
        "rays": None if rays is None else whole("rays", rays, 1000, 4_194_304),
    }
    columns, told = raw.light(asked)
    figures = json.loads(told)
    warnings = figures.pop("warnings")
    return Light(**{name: array(columns[name]) for name in COLUMNS}, figures=figures, warnings=warnings)

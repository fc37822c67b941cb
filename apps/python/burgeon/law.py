"""Growth laws."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any, Dict, Mapping, Sequence, Tuple

from . import _burgeon
from ._files import write_whole
from ._given import beyond, coloured, flag, number, path, whole, word, wrong
from ._recipe import Recipe, recipe

if TYPE_CHECKING:
    import numpy as np

__all__ = ["Law"]


class Law:
    """Growth laws of organs (``burgeon bloom fit``)."""

    __slots__ = ("_raw",)

    def __init__(self, raw: Any) -> None:
        self._raw = raw

    def __reduce__(self) -> "Tuple[Any, ...]":
        return _of_json, (self._raw.json(),)

    def __copy__(self) -> "Law":
        return self

    def __deepcopy__(self, memo: Any) -> "Law":
        return self

    def __eq__(self, other: object) -> bool:
        """Compares the laws and all their measures."""
        if not isinstance(other, Law):
            return NotImplemented
        return self is other or self._raw.json() == other._raw.json()

    def __hash__(self) -> int:
        return hash(self._raw.json())

    @classmethod
    def fit(
        cls,
        days: "Sequence[float]",
        sizes: "Sequence[float] | Mapping[str, Sequence[float]]",
        name: str = "plant",
        budget: float = 1.0,
    ) -> "Law":
        """Fits a law to sizes.

        ``days``: (n,), at least 3, increasing; ``sizes``: (n,), metres, or a dict of such by the names of organs. Those of one
        kind (``leaf-1``, ``leaf-2``) share rate and time. The form is logistic, Gompertz, monomolecular or straight: the one that
        predicts omitted days best. ``budget``: factor by which the usual limit, some 49,000 sizes, may be exceeded.
        """
        organs = sizes if isinstance(sizes, Mapping) else {name: sizes}
        when = _numbers(days, "days")
        if (when[1:] <= when[:-1]).any():
            raise wrong("days must increase from one to the next", "days", when.tolist(), "increasing")
        rows = []
        for organ, values in organs.items():
            row = _numbers(values, f"sizes of {organ}" if isinstance(sizes, Mapping) else "sizes")
            if len(row) != len(when):
                line = f"sizes of {organ}: there are {len(row)} for {len(when)} days"
                raise wrong(line, "sizes", f"{len(row)} numbers", f"{len(when)} numbers")
            rows.append((str(organ), when.tolist(), row.tolist()))
        return cls(_burgeon.RawLaw.fit(name, rows, number("budget", budget, 1, 1000)))

    @classmethod
    def fit_scans(
        cls,
        scans: "Mapping[float, Any]",
        name: str = "plant",
        unit: str = "m",
        up: str = "y",
        single: bool = False,
        seed: int = 1,
        budget: float = 1.0,
    ) -> "Law":
        """Fits a law to scans of one plant on at least 3 days (``burgeon bloom fit``).

        ``scans``: a dict from days to clouds of points, each a file or an array (points, 3); the rest as for ``bloom``, which
        then makes the plant of any day: ``bloom(scans, 2.5, law=law)``.
        """
        return cls(scans_of(name, scans, unit, up, single, seed, budget).make().law())

    @classmethod
    def read(cls, path: "str | os.PathLike[str]") -> "Law":
        """Reads a law that ``burgeon bloom fit`` or ``save`` wrote."""
        with open(path, encoding="utf-8") as file:
            return cls(_burgeon.RawLaw.read(file.read()))

    def save(self, path: "str | os.PathLike[str]") -> None:
        """Writes it as JSON, which ``burgeon bloom run --law`` reads, too."""
        folder, name = os.path.split(os.fspath(path))
        write_whole(folder, [(name, (json.dumps(self.to_dict(), indent=2) + "\n").encode())])

    def to_dict(self) -> "Dict[str, Any]":
        """Returns all of it: for each organ ``form``, ``K``, ``p0``, ``r``, ``r2``, ``standard_errors``, ``loo_rmse``, ..."""
        return json.loads(self._raw.json())

    @property
    def organs(self) -> "list[str]":
        """Names of the organs."""
        return [law["organ"] for law in self.to_dict()["laws"]]

    @property
    def determined(self) -> "list[bool]":
        """Whether the days determine the law of each organ; an undetermined law sets no pace."""
        return self._raw.determined()

    def __call__(self, day: "float | Sequence[float]", organ: int = 0) -> "float | np.ndarray":
        """Returns the size on a day or on several, counted as in the fit, metres."""
        import numpy as np

        days = np.asarray(day, np.float64)
        values = np.array(self._raw.values(organ, days.ravel().tolist())).reshape(days.shape)
        return float(values) if days.ndim == 0 else values

    def __repr__(self) -> str:
        laws = ", ".join(f"{law['organ']}: {law['form']}" for law in self.to_dict()["laws"])
        return f"<burgeon.Law {laws}>"


def _of_json(text: str) -> Law:
    return Law(_burgeon.RawLaw.read(text))


def scans_of(
    name: str,
    scans: "Mapping[float, Any]",
    unit: str,
    up: str,
    single: bool,
    seed: int,
    budget: float,
    texture: str = "scan",
) -> Recipe:
    """Returns the recipe of scans of several days, in the order of the days."""
    rows = []
    for key, cloud in scans.items():
        row: "Dict[str, Any]" = {"day": number("scans: a day", key, -1e4, 1e4, "d"), "file": None, "points": b"", "colors": b""}
        if isinstance(cloud, (str, os.PathLike)):
            file = path("scans", cloud)
            with open(file, "rb") as read:
                row["file"] = (read.read(), os.path.basename(file))
        else:
            found, row["colors"] = coloured(cloud, f"scans[{key}]")
            row["points"] = found.tobytes()
        rows.append(row)
    rows.sort(key=lambda row: row["day"])
    if not rows:
        raise wrong("there are no scans: give a dict from days to clouds", "scans", "{}", "one day or more")
    days = (word("unit", unit), word("up", up), texture)
    seed, budget = whole("seed", seed, 0, 2**64 - 1), number("budget", budget, 1, 1000)
    return recipe("RawDays", word("name", name), rows, days, flag("single", single), seed, budget)


def _numbers(values: Any, what: str) -> "np.ndarray":
    import numpy as np

    row = np.asarray(values)
    if row.dtype.kind not in "fiu" or row.ndim != 1:
        raise beyond(what, f"{row.dtype} of shape {row.shape}", "numbers of shape (n,)")
    row = row.astype(np.float64)
    if not np.isfinite(row).all():
        at = int(np.argmin(np.isfinite(row)))
        raise beyond(f"{what}[{at}]", float(row[at]), "finite")
    return row

"""The recipe of a plant: enough to make it again, with the same bits. Pickles hold this and no meshes."""

from __future__ import annotations

import copy
from typing import Any, NamedTuple, Optional, Tuple

from . import _burgeon


class Recipe(NamedTuple):
    """A call of the core, or of a method of another recipe's result."""

    function: str
    arguments: "Tuple[Any, ...]"
    before: "Optional[Recipe]" = None

    def make(self) -> Any:
        """Returns the result."""
        of = _burgeon if self.before is None else self.before.make()
        return self.of(of)

    def of(self, there: Any) -> Any:
        """Returns the result, if that of the recipe before is already made."""
        made = getattr(there, self.function)(*[_raw(argument) for argument in self.arguments])
        return made[0] if isinstance(made, list) else made


def recipe(function: str, *arguments: Any, before: "Optional[Recipe]" = None) -> Recipe:
    """Returns a recipe that later changes of the caller's lists and dicts do not affect."""
    return Recipe(function, copy.deepcopy(arguments), before)


def _raw(argument: Any) -> Any:
    return argument._raw if hasattr(argument, "_raw") else argument

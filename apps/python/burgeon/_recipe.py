"""What a plant is made of: enough to make it again, the same to the bit. Pickles hold this and no meshes."""

from __future__ import annotations

import copy
from typing import Any, NamedTuple, Optional, Tuple

from . import _burgeon


class Recipe(NamedTuple):
    """A call of the core, or of a method of what another recipe makes."""

    function: str
    arguments: "Tuple[Any, ...]"
    before: "Optional[Recipe]" = None

    def make(self) -> Any:
        """What comes out."""
        of = _burgeon if self.before is None else self.before.make()
        return self.of(of)

    def of(self, there: Any) -> Any:
        """What comes out where what is before was made already."""
        made = getattr(there, self.function)(*[_raw(argument) for argument in self.arguments])
        return made[0] if isinstance(made, list) else made


def recipe(function: str, *arguments: Any, before: "Optional[Recipe]" = None) -> Recipe:
    """A recipe that no later change of a list or dict of the caller's reaches."""
    return Recipe(function, copy.deepcopy(arguments), before)


def _raw(argument: Any) -> Any:
    return argument._raw if hasattr(argument, "_raw") else argument

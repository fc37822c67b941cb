"""Exceptions with a code and fields."""

from __future__ import annotations

__all__ = ["BudgetError", "BurgeonError", "SpecError"]


class BurgeonError(Exception):
    """A request that Burgeon refuses.

    ``code`` is a word that never changes its meaning (empty if there is none), ``fields`` are the values in the message.
    """

    def __init__(self, message: str, code: str = "", fields: "dict[str, str] | None" = None) -> None:
        super().__init__(message)
        self.code = code
        self.fields = dict(fields or {})

    def __reduce__(self):
        return type(self), (str(self), self.code, self.fields)

    @property
    def field(self) -> "str | None":
        """Names and rows that lead to the field at fault, such as ``method.tropisms[1].strength``."""
        if "field" in self.fields:
            return self.fields["field"]
        # An unknown or missing name is separate from the path of its table.
        name = self.fields.get("name") if self.code in ("spec-unknown", "spec-missing") else None
        return ".".join(filter(None, (self.fields.get("path"), name))) or None

    @property
    def value(self) -> "str | None":
        """The value of the field."""
        if self.code == "spec-choice":
            return self.fields.get("name")
        return self.fields.get("value") or self.fields.get("found")

    @property
    def range(self) -> "str | None":
        """The valid values of the field: a range such as ``0 to 2 m``, the known words, or the type."""
        return next((self.fields[name] for name in ("range", "choices", "wanted") if name in self.fields), None)


class SpecError(BurgeonError, ValueError):
    """The request cannot be made: an unknown field, a number out of range, a file of another kind."""


class BudgetError(SpecError):
    """The request exceeds a limit; ``budget=`` raises the limits (docs/limits.md)."""

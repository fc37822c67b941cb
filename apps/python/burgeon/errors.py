"""What can go wrong, as exceptions with a code and fields."""

from __future__ import annotations

__all__ = ["BudgetError", "BurgeonError", "SpecError"]


class BurgeonError(Exception):
    """What Burgeon refuses.

    ``code`` is a word that never changes its meaning (empty where there is none), ``fields`` says what the sentence is
    filled with.
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
        # Of what is not known, and of what is missing, the name stands beside the path of what it belongs to.
        name = self.fields.get("name") if self.code in ("spec-unknown", "spec-missing") else None
        return ".".join(filter(None, (self.fields.get("path"), name))) or None

    @property
    def value(self) -> "str | None":
        """What the field was given."""
        if self.code == "spec-choice":
            return self.fields.get("name")
        return self.fields.get("value") or self.fields.get("found")

    @property
    def range(self) -> "str | None":
        """What the field may be, such as ``0 to 2 m``; of a word, those that are known; of another kind, the kind."""
        return next((self.fields[name] for name in ("range", "choices", "wanted") if name in self.fields), None)


class SpecError(BurgeonError, ValueError):
    """What was asked for cannot be made: an unknown field, a number out of range, a file that is none."""


class BudgetError(SpecError):
    """It would have been too much; ``budget=`` raises the limits (docs/limits.md)."""

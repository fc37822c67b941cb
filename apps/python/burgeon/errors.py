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
        return self.fields.get("field") or self.fields.get("path") or self.fields.get("name")

    @property
    def value(self) -> "str | None":
        """What the field was given."""
        return self.fields.get("value")

    @property
    def range(self) -> "str | None":
        """What the field may be, such as ``0 to 2 m``."""
        return self.fields.get("range")


class SpecError(BurgeonError, ValueError):
    """What was asked for cannot be made: an unknown field, a number out of range, a file that is none."""

    def __init__(self, message: str, code: str = "", fields: "dict[str, str] | None" = None) -> None:
        super().__init__(message + _meant(message), code, fields)

    def __reduce__(self):
        # The hint is in the message already.
        return _again, (str(self), self.code, self.fields)


class BudgetError(SpecError):
    """It would have been too much; ``budget=`` raises the limits (docs/limits.md)."""


def _again(message: str, code: str, fields: "dict[str, str]") -> SpecError:
    error = SpecError.__new__(SpecError, message)
    BurgeonError.__init__(error, message, code, fields)
    return error


def _meant(message: str) -> str:
    """Of a word that is not known, which of those that are known is meant."""
    import re

    preset = re.match(r'there is no (?:preset|flower) "([^"]*)"; there are (.*)', message)
    if preset:
        words = [preset[1], *preset[2].split(", ")]
    elif "unknown field" in message or "unknown variant" in message:
        words = re.findall(r"`([^`]+)`", message)
    else:
        return ""
    import difflib

    if len(words) < 2:
        return ""

    near = difflib.get_close_matches(words[0], words[1:], n=1, cutoff=0.5)
    return f"; is `{near[0]}` meant?" if near else ""

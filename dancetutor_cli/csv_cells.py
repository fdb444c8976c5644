"""Cells of a CSV file that a spreadsheet takes for text, whatever they begin with, and how they are read back."""

from __future__ import annotations

# With these a spreadsheet takes a cell for a formula, says OWASP; some of them know the wide forms, too.
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\uff1d", "\uff0b", "\uff0d", "\uff20")


def as_text(cell: str) -> str:
    """A text of other people as a cell: what would be a formula begins with an apostrophe, also behind blanks."""
    return f"'{cell}" if _is_formula(cell) else cell


def text_of(cell: str) -> str:
    """The text of which `as_text` has made a cell."""
    return cell[1:] if cell.startswith("'") and _is_formula(cell[1:]) else cell


def _is_formula(cell: str) -> bool:
    return cell.lstrip(" ").startswith(_FORMULA)

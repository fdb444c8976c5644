"""DT108: two charts of one difficulty."""

from __future__ import annotations

from dancetutor_cli.lint.rule import ReaderRule


class DuplicateDifficulty(ReaderRule):
    """Two charts of the same steps type have the same difficulty: the games show the second as an Edit.

    Bad: dance-single Hard twice.

    Better: one Hard, one Challenge, and an Edit with a name.
    """

    code = "DT108"
    name = "duplicate-difficulty"
    codes = frozenset({"duplicate-difficulty"})

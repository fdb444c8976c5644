"""DT104: a value of the file that games read differently."""

from __future__ import annotations

from dancetutor_cli.lint.rule import ReaderRule


class OddTag(ReaderRule):
    """A tag has a wrong value: a decimal comma, a meter that is no number, a difficulty that no game knows.

    A lost value that no player sees, such as that of MENUCOLOR, is an info.

    Bad: #OFFSET:1,5;

    Better: #OFFSET:1.5;
    """

    code = "DT104"
    name = "odd-tag"
    codes = frozenset(
        {
            "odd-offset",
            "odd-directive",
            "odd-meter",
            "odd-difficulty",
            "odd-time-signature",
            "hash-in-value",
            "hash-in-unused-value",
            "nul-byte",
            "cr-only",
        }
    )
    usual = frozenset({"hash-in-unused-value"})

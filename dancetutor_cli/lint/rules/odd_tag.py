"""DT104: a value of the file that the games read in a way of their own."""

from __future__ import annotations

from dancetutor_cli.lint.rule import ReaderRule


class OddTag(ReaderRule):
    """A tag is not what it should be: a decimal comma, a meter that is no number, a difficulty no game knows.

    A value that is lost where no player sees it, such as MENUCOLOR's, is an info.

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

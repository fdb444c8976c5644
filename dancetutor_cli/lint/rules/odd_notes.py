"""DT102: note data that the games read in a way of their own."""

from __future__ import annotations

from dancetutor_cli.lint.rule import ReaderRule


class OddNotes(ReaderRule):
    """Rows are too short or too long, characters are unknown, or rows are so close that one overwrites the other.

    The games read around it, each in its own way, and so does the program, as ITGmania does. What StepF2 writes for
    itself, and charts for several players, are told as an info.

    Bad:

        1000  L
        001
        0x00
        0001  R

    Better:

        1000  L
        0010  R
        0100  L
        0001  R
    """

    code = "DT102"
    name = "odd-notes"
    codes = frozenset(
        {
            "compound-note",
            "odd-keysound",
            "long-row",
            "short-row",
            "unknown-note",
            "row-collision",
            "several-players",
            "stepf2-note",
        }
    )
    usual = frozenset({"several-players", "stepf2-note"})

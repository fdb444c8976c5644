"""DT106: a hold or roll without a head or an end."""

from __future__ import annotations

from dancetutor_cli.lint.rule import ReaderRule


class BrokenHold(ReaderRule):
    """A hold has no end, an end has no head, or a note stands inside a hold: the games drop one of the two.

    Bad:

        2000
        0000
        1000
        3000

    Better:

        2000  L
        3000
        1000  L
        0001  R
    """

    code = "DT106"
    name = "broken-hold"
    codes = frozenset({"unmatched-head", "unmatched-tail"})

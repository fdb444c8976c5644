"""DT208: a footswitch on a side panel."""

from __future__ import annotations

from dancetutor_cli.lint.rule import MoveRule


class Sideswitch(MoveRule):
    """One foot takes over the left or right panel that the other stands on, so the body has to turn sideways for it.

    Bad:

        1000  L
        0001  R
        0001  L
        0100  R

    Better:

        1000  L
        0001  R
        0100  L
        0100  R
    """

    code = "DT208"
    name = "sideswitch"
    move = "sideswitch"
    description = "a foot takes over a side panel from the other: sideswitch"

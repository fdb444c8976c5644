"""DT212: a footswitch where the chart is too easy for it."""

from __future__ import annotations

from dancetutor_cli.lint.rule import MoveRule


class Footswitch(MoveRule):
    """One foot takes over the panel that the other stands on, in a chart whose players do not know footswitches yet.

    Off for most charts; configs/lint/default.yaml switches it on for the lowest difficulties.

    Bad:

        1000  L
        0100  R
        0100  L
        0001  R

    Better:

        1000  L
        0100  R
        0010  L
        0001  R
    """

    code = "DT212"
    name = "footswitch"
    move = "footswitch"
    said = "a foot takes over the panel of the other: footswitch"

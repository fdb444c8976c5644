"""DT302: a hand is needed."""

from __future__ import annotations

from dancetutor_cli.lint.rule import MoveRule


class Hand(MoveRule):
    """Both feet are busy, so a hand has to press a panel, in a chart whose players do not use hands yet.

    Off for most charts; configs/lint/default.yaml switches it on for the lower difficulties.

    Bad:

        1000  L
        0100  R
        1101  L>R
        0000

    Better:

        1000  L
        0100  R
        1001  LR
        0000
    """

    code = "DT302"
    name = "hand"
    move = "hand"
    said = "a hand has to press a panel"

"""DT206: in a jump, a foot leaves its panel to the other foot."""

from __future__ import annotations

from dancetutor_cli.lint.rule import MoveRule


class JumpFootswitch(MoveRule):
    """In this jump a foot that already stands on one of its panels has to change to another one, and quickly.

    `max_seconds`: only jumps at most this long after the step before count; with more time nobody notices.

    Bad (max_seconds = 0.6):

        1000  L
        0010  R
        0001  R
        1001  RL

    Better (max_seconds = 0.6):

        1000  L
        0010  R
        0001  R
        1001  LR
    """

    code = "DT206"
    name = "jump-footswitch"
    move = "jump-footswitch"
    said = "a foot changes panels within this jump: jump footswitch"

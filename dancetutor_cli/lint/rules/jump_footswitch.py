"""DT206: in a jump, a foot leaves its panel to the other foot."""

from __future__ import annotations

from dancetutor_cli.lint.rule import MoveRule


class JumpFootswitch(MoveRule):
    """In this jump a foot that already stands on one of its panels has to change to another one, and quickly.

    `max_seconds`: only jumps at most this long after the step before count; with more time nobody notices. by-meter:
    what at most `share` per cent of the charts of a meter have.

    Bad (max_seconds = 0.6): the right foot has just come to the panel that the left foot needs.

        1000  L
        0001  R
        0100  R
        0110  LR

    Better (max_seconds = 0.6):

        1000  L
        0001  R
        0010  R
        0110  LR
    """

    code = "DT206"
    name = "jump-footswitch"
    move = "jump-footswitch"
    times = "jump-footswitch"
    description = "a foot changes panels within this jump: jump footswitch"

"""DT202: the body turns all the way round."""

from __future__ import annotations

from dancetutor_cli.lint.rule import MoveRule


class Spin(MoveRule):
    """The shortest turn to this row passes behind the dancer's back, beyond 180 degrees: she spins.

    Bad: the crossover goes on in place of being unwound.

        1000  L
        0100  R
        0001  L
        0010  R

    Better: back the way it came.

        1000  L
        0100  R
        0001  L
        0100  R
    """

    code = "DT202"
    name = "spin"
    move = "spin"
    said = "the body turns beyond 180 degrees: a spin"

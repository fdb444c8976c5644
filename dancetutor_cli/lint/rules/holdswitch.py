"""DT211: the feet change on a held panel."""

from __future__ import annotations

from dancetutor_cli.lint.rule import MoveRule


class Holdswitch(MoveRule):
    """A hold has to be handed from one foot to the other while it lasts.

    Bad: the right foot takes over the left panel, so that the left foot can step down.

        2000  L
        0001  R
        0100  L
        3001  L

    Better: one foot holds, the other steps.

        2000  L
        0001  R
        0100  R
        3001  R
    """

    code = "DT211"
    name = "holdswitch"
    move = "holdswitch"
    description = "the feet change on a held panel: holdswitch"

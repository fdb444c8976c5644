"""The clock that is heard: a play at another speed of its music."""

from __future__ import annotations

from dataclasses import replace

from dancetutor_cli.play.played import Play


def at_rate(play: Play, rate: float) -> Play:
    """A play whose seconds are those of the music as it is heard at a rate: at half speed notes come twice as late."""
    return replace(play, rows=replace(play.rows, second=play.rows.second / rate))

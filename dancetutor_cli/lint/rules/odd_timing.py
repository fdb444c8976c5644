"""DT105: a BPM, stop or warp that cannot be meant."""

from __future__ import annotations

from dancetutor_cli.lint.rule import ReaderRule


class OddTiming(ReaderRule):
    """A BPM, stop, delay or warp is negative, not a number, overlaps another or has no BPM to stand on.

    Negative values are an old gimmick; as warps in .ssc they say what they do.

    Bad: #BPMS:0.000;

    Better: #BPMS:0.000=120.000;
    """

    code = "DT105"
    name = "odd-timing"
    codes = frozenset({"odd-timing", "no-bpm", "split-timing-without-bpms", "negative-timing"})

"""The state of the dancer between rows, and the events that depend on several rows. Kernel code."""

from __future__ import annotations

import numpy as np

from dancetutor_cli.feet.solver.compiled import inner_kernel
from dancetutor_cli.feet.solver.packing import (
    DRILL_LENGTH,
    DRILL_SECONDS,
    DRILL_TICKS,
    EPSILON,
    GALLOP_NEIGHBOURS,
    GALLOP_SECONDS,
    GALLOP_TICKS,
    STREAM_LENGTH,
    STREAM_SECONDS,
    STREAM_TICKS,
)
from dancetutor_cli.feet.solver.vocabulary import EVENTS

LEFT_AT, RIGHT_AT = 0, 1  # places of the feet, see `packing.Geometry`
SIDE = 2  # how a facing of 180 degrees was reached: 1 as +180, 2 as -180; 0 for other facings
LAST = 3  # last leg: 0 none, 1 left, 2 right
LEFT_HELD, RIGHT_HELD = 4, 5  # parts of a foot that a hold reserves: bit 0 the heel or the whole foot, bit 1 the toe
LEFT_HOLDS, RIGHT_HOLDS = 6, 7  # panel + 1 that a hand holds, 0 none
LEFT_LIFTED, RIGHT_LIFTED = 8, 9  # 1 while a foot is off its panel because of a mine
NUMBERS = 10
PLACE_BITS = 5  # the places of the feet are the lowest bits of the packed state, then comes SIDE


@inner_kernel
def pack(s):  # type: ignore[no-untyped-def]
    """Pack the ten numbers of a state into one: 5 + 5 + 2 + 2 + 2 + 2 + 4 + 4 + 1 + 1 bits."""
    low = s[0] | s[1] << 5 | s[2] << 10 | s[3] << 12 | s[4] << 14 | s[5] << 16
    return low | s[6] << 18 | s[7] << 22 | s[8] << 26 | s[9] << 27


@inner_kernel
def unpack(key, s):  # type: ignore[no-untyped-def]
    """Write the numbers of a packed state into `s`."""
    s[0], s[1], s[2], s[3], s[4] = key & 31, key >> 5 & 31, key >> 10 & 3, key >> 12 & 3, key >> 14 & 3
    s[5], s[6], s[7], s[8], s[9] = key >> 16 & 3, key >> 18 & 15, key >> 22 & 15, key >> 26 & 1, key >> 27 & 1


@inner_kernel
def turn(before, side, after):  # type: ignore[no-untyped-def]
    """Return for a turn between two facings its unsigned degrees, whether it is a spin, and the new side."""
    back = abs(before) >= 180.0 - EPSILON
    start = -180.0 if back and side == 2 else before
    delta = after - start
    while delta > 180.0 + EPSILON:
        delta -= 360.0
    while delta <= -180.0 - EPSILON:
        delta += 360.0
    if abs(delta) >= 180.0 - EPSILON:
        return 180.0, False, 0
    ends_back = abs(after) >= 180.0 - EPSILON
    if back and ends_back:
        return 0.0, False, side
    end = start + delta
    spin = abs(end) > 180.0 + EPSILON and not (back and side == 0)
    return abs(delta), spin, ((1 if end > 0 else 2) if ends_back else 0)


# Events that depend on several rows: jacks, candles, gallops, streams, drills.
#
# Their time limits and lengths are in configs/moves.yaml.

_JACK, _CANDLE, _GALLOP, _STREAM, _DRILL = (
    1 << EVENTS.index(name) for name in ("jack", "candle", "gallop", "stream", "drill")
)
_NOT_SWITCHES = ~sum(1 << bit for bit, name in enumerate(EVENTS) if "switch" in name)
_STEPPED = 1 << 30  # a temporary mark of rows with steps
assert len(EVENTS) < 30


@inner_kernel
def name_neighbours(rows, found, rules):  # type: ignore[no-untyped-def]
    """Add the events that depend on several rows to `found.events`. The limbs are read from `found.limb`.

    rows : `RowArrays`
    """
    tick, second, limb, events = rows.tick, rows.second, found.limb, found.events
    limits, long = rules.limits, rules.long
    n, c = limb.shape
    met = drill_from = 0  # number of rows with steps so far; the number of the drill's first row
    before = drill_row = np.int64(-1)  # the row with steps before this one; the row of `drill_from`
    foot, panel, panel_before = -1, -1, -1  # of the single step of that row, and of the row before it
    # about the row before: its foot differs from the one before; it may be a gallop; it is in a drill
    others = near = drilling = False
    earlier = latest = np.inf  # seconds between the last rows
    links = 0  # number of pairs of rows in the current stream
    stream_row = np.int64(-1)
    for r in range(n):
        now, on, count = -1, -1, 0
        for p in range(c):
            if limb[r, p] != -1:
                now, on, count = int(limb[r, p]), p, count + 1
        if not count:
            continue
        if count > 1 or now < 0 or now > 1:
            now, on = -1, -1
        events[r] |= _STEPPED
        if not met:
            events[r] &= _NOT_SWITCHES  # the starting stance is not a step, so no foot can take it over
            drill_row = np.int64(r)
        else:
            ticks, seconds = tick[r] - tick[before], second[r] - second[before]
            both = now >= 0 and foot >= 0
            other = both and now != foot
            if both and now == foot and on == panel:
                events[r] |= _JACK
            if other and others and long[on, panel_before]:
                events[r] |= _CANDLE
            if near and min(earlier, seconds) >= limits[GALLOP_NEIGHBOURS] * latest - EPSILON:
                events[before] |= _GALLOP
            near = other and ticks <= limits[GALLOP_TICKS] and seconds <= limits[GALLOP_SECONDS] + EPSILON
            if both and ticks <= limits[STREAM_TICKS] and seconds <= limits[STREAM_SECONDS] + EPSILON:
                if not links:
                    stream_row = before
                links += 1
            else:
                if links and links + 1 >= limits[STREAM_LENGTH]:
                    _mark(events, stream_row, before, _STREAM)
                links = 0
            linked = other and on != panel
            linked = linked and ticks <= limits[DRILL_TICKS] and seconds <= limits[DRILL_SECONDS] + EPSILON
            if not linked or (drilling and on != panel_before):  # the second step of a drill may be on any panel
                if met - drill_from >= limits[DRILL_LENGTH]:
                    _mark(events, drill_row, before, _DRILL)
                drill_from, drill_row = (met - 1, before) if linked else (met, np.int64(r))
            drilling, others = linked, other
            earlier, latest = latest, seconds
        panel_before, panel, foot, before = panel, on, now, np.int64(r)
        met += 1
    if near and earlier >= limits[GALLOP_NEIGHBOURS] * latest - EPSILON:
        events[before] |= _GALLOP
    if links and links + 1 >= limits[STREAM_LENGTH]:
        _mark(events, stream_row, before, _STREAM)
    if met > 1 and met - drill_from >= limits[DRILL_LENGTH]:
        _mark(events, drill_row, before, _DRILL)
    for r in range(n):
        events[r] &= ~_STEPPED


@inner_kernel
def _mark(events, first, last, event):  # type: ignore[no-untyped-def]
    """Add an event to the rows with steps from `first` to `last`."""
    for r in range(first, last + 1):
        if events[r] & _STEPPED:
            events[r] |= event

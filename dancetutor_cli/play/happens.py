"""What happens in a row and its neighbours: jacks, candles, gallops, streams, drills. Kernel code.

From which time and length on they are called so stands in configs/moves.yaml.
"""

from __future__ import annotations

import numpy as np

from dancetutor_cli.play.jit import inner_kernel
from dancetutor_cli.play.tables import (
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
)  # fmt: skip
from dancetutor_cli.play.vocabulary import EVENTS

_JACK, _CANDLE, _GALLOP, _STREAM, _DRILL = (
    1 << EVENTS.index(name) for name in ("jack", "candle", "gallop", "stream", "drill")
)
_NOT_SWITCHES = ~sum(1 << bit for bit, name in enumerate(EVENTS) if "switch" in name)
_STEPPED = 1 << 30  # while they are looked for: a row with steps
assert len(EVENTS) < 30


@inner_kernel
def name_neighbours(rows, found, rules):  # type: ignore[no-untyped-def]
    """Add to `found.events` what shows only from row to row. rows : `RowArrays`; of `found.limb` is looked at."""
    tick, second, limb, events = rows.tick, rows.second, found.limb, found.events
    limits, long = rules.limits, rules.long
    n, c = limb.shape
    met = drill_from = 0  # rows with steps so far; the first of the drill that goes on
    before = drill_row = np.int64(-1)  # the row with steps before this one; that of `drill_from`
    foot, panel, panel_before = -1, -1, -1  # of the one step of that row, and of the row before it
    others = near = drilling = False  # of the row before: another foot than before; maybe a gallop; a drill goes on
    earlier = latest = np.inf  # seconds between the last rows
    links = 0  # of the stream that goes on
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
            events[r] &= _NOT_SWITCHES  # the starting stance is no step that another foot could take over
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
            if not linked or (drilling and on != panel_before):  # the second step of a run is on whatever panel
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
    """Add an event to the rows with steps from one to another."""
    for r in range(first, last + 1):
        if events[r] & _STEPPED:
            events[r] |= event

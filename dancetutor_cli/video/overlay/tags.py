"""Words beside the notes: how large their letters are, how much room they need, in how many lines they stand."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from dancetutor_cli.video.clock import Pass
from dancetutor_cli.video.move_words import short_words
from dancetutor_cli.video.notes import Callout, NoteTrack
from dancetutor_cli.video.overlay.sprites import FLAG_EDGE
from dancetutor_cli.video.overlay.text import Typeface, fitted, narrowest

LETTERS, LEAST = 15.0, 10.4  # pixels of letters that room is left for: in a layout's default size, and in any
LINES, MOST_LINES = 2, 4  # lines of a phrase; of all phrases, where there are commas
SEEN = 4.0  # seconds before its row that a tag, or a note, may be in the picture
LONG, LONG_APART = (
    20,
    1.2,
)  # letters of tags that stand at least so many seconds apart: brackets made a wall of small ones
LABEL = 4  # pixels left and right of the words in their label, beside FLAG_EDGE
NEAR = 0.95  # of the letters' size that is as good as all of it: sizes are tried in steps
FEWER = 0.85  # and so much that is better than more lines, if these are not smaller than `LEAST`


def letters(scale: float) -> float:
    """The size of letters that room is left for, pixels; scale : of the layout."""
    return max(LETTERS * scale, LEAST)


def seen(callouts: Iterable[Callout], passes: Iterable[Pass]) -> bool:
    """Does any of these stand beside the notes in one of these runs?"""
    begins = np.array([told.second for told in callouts])
    return any(((one.start <= begins) & (begins <= one.end + SEEN)).any() for one in passes)


def limbs_seen(notes: NoteTrack, passes: Iterable[Pass]) -> set[int]:
    """Whose notes, `play.played.Limb`, are in the picture in these runs: of a section not all of the song's."""
    here = np.zeros(len(notes.second), dtype=np.bool_)
    for one in passes:
        here |= (one.start <= notes.end_second) & (notes.second <= one.end + SEEN)
    return {int(limb) for limb in np.unique(notes.limb[here]) if limb >= 0}


class RowTag(NamedTuple):
    """Words beside a row. second : of the music; beat : the same as drawn; severity : as of `Callout`"""

    second: float
    beat: float
    words: str
    severity: str


def row_tags(callouts: Iterable[Callout]) -> list[RowTag]:
    """Each passage's tag where it begins, and those of its other moves, in order of time.

    Of long ones that follow each other quickly, such as brackets', the first: the calls beside her tell the others.
    """
    found = [
        RowTag(*one, call.severity) for call in callouts for one in ((call.second, call.beat, call.tag), *call.further)
    ]
    kept, last = [], -np.inf
    for one in sorted(found, key=lambda one: one.second):
        if len(one.words) > LONG:
            if one.second - last < LONG_APART:
                continue
            last = one.second
        kept.append(one)
    return kept


def told(callouts: Iterable[Callout], words: Iterable[str]) -> set[str]:
    """What may be said beside the notes: what is, and what always is the same, so that lanes of most films are alike.

    words : of moves, some with {who} and {places} to be filled in
    """
    tags = {tag for one in callouts for tag in (one.tag, *(tag for *_, tag in one.further))}
    return tags | {short_words(said) for said in words if "{" not in said}


def room_for(tags: Iterable[str], size: float, face: Typeface) -> float:
    """Pixels that the widest of these words need with their label, at this size; each phrase in two lines at most."""
    phrases = {phrase for tag in tags for phrase in tag.split(", ")}
    widest = max((narrowest(phrase, size, face, LINES) for phrase in phrases), default=0.0)
    return widest + FLAG_EDGE * size + LABEL


def laid(tag: str, size: float, least: float, room: float, face: Typeface) -> tuple[list[str], float]:
    """The lines of a tag, and the size of its letters: at most `size`, at least `least` if they can be; none is cut.

    room : pixels for the label
    """
    enough = NEAR * max(FEWER * least, min(least, LEAST))
    for most in range(LINES, MOST_LINES + 1):
        lines, fits = fitted(tag, size, room - FLAG_EDGE * size - LABEL, face, most)
        if fits >= enough:
            break
    return lines, fits

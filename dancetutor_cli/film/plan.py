"""A film's plan: everything that its frames need, as plain data that pickles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.film.clock import Clock
from dancetutor_cli.film.layout import FilmLook
from dancetutor_cli.film.notes import BeatLines, Callout, Cue, NoteTrack, Presses
from dancetutor_cli.film.overlay.captions import SongShape
from dancetutor_cli.film.overlay.diagram import DiagramRows
from dancetutor_cli.film.overlay.header import Words
from dancetutor_cli.film.scene.camera import is_front_view
from dancetutor_cli.film.scene.look import default_look

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.dance.motion import Motion
    from dancetutor_cli.film.picture import PadLike


@dataclass(frozen=True, slots=True)
class FilmPlan:
    """Everything about a film before the first frame; worker processes get it pickled.

    beats : float64 (clock.frames,), the beat each frame shows, as drawn
    directions : per column, degrees clockwise from up, None for a middle panel
    character : who dances, the motions are for its skeleton; None for the project's own dancer
    scroll_bpm : the tempo of which M mods make their speed
    speeds : float64 (clock.frames,), how far apart notes are drawn in each frame; None: always 1
    motions : each dancer's at each rate of the clock's passes, in seconds of the music as it is heard there; none where
        the layout has no dancer; rows : the play's, for the next rows' pads
    callouts : words in the picture; cues : moves for the subtitles
    fade : seconds of the film at its end in which the picture goes dark
    """

    look: FilmLook
    clock: Clock
    words: Words
    song: SongShape
    notes: NoteTrack
    presses: Presses
    lines: BeatLines
    beats: NDArray[np.float64]
    scroll_bpm: float
    directions: tuple[float | None, ...]
    motions: Mapping[float, tuple[Motion, ...]]
    pad: PadLike | None
    rows: DiagramRows | None = None
    callouts: tuple[Callout, ...] = ()
    cues: tuple[Cue, ...] = ()
    speeds: NDArray[np.float64] | None = None
    character: Character | None = None
    fade: float = 0.0

    @property
    def dancers(self) -> int:
        """The number of dancers in the picture."""
        return max((len(some) for some in self.motions.values()), default=0)

    def light(self, frame: int) -> float:
        """How bright a frame's picture is, 0 to 1: less and less towards the end, 0 in the last frame."""
        left = (self.clock.frames - 1 - frame) / self.clock.fps
        return left / self.fade if left < self.fade else 1.0


def turned(look: FilmLook) -> bool:
    """Whether the dancer of this look faces the viewer."""
    part = look.layout.dancer
    if part is None or look.layout.screen is not None:
        return False
    return is_front_view(look.camera or part.camera, default_look())

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
from dancetutor_cli.film.overlay.diagram import DiagramRows
from dancetutor_cli.film.overlay.footer import SongShape
from dancetutor_cli.film.overlay.header import Words
from dancetutor_cli.film.scene.camera import is_front_view
from dancetutor_cli.film.scene.look import default_look

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.dance.motion import Motion
    from dancetutor_cli.film.picture import PadLike


@dataclass(frozen=True, slots=True)
class FilmPlan:
    """The data of a film that are known before its first frame. Worker processes get the plan pickled.

    beats : float64 (clock.frames,), the beat that each frame shows, as drawn
    directions : for each column, degrees clockwise from up, None for a middle panel
    character : the character who dances, whose skeleton the motions are for; None for the project's own dancer
    scroll_bpm : the tempo from which M mods make their speed
    speeds : float64 (clock.frames,), the factor of the distances between notes in each frame; None: always 1
    motions : the motion of each dancer at each rate of the clock's passes, in seconds of the music as it is heard at
        that rate; empty for a layout without a dancer
    rows : the rows of the play, for the pads of the next rows
    callouts : words in the picture; cues : moves for the subtitles
    fade : seconds at the end of the film in which the picture goes dark
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
        """Return the brightness of a frame, 0 to 1: it falls towards the end of the film, to 0 in the last frame."""
        left = (self.clock.frames - 1 - frame) / self.clock.fps
        return left / self.fade if left < self.fade else 1.0


def faces_viewer(look: FilmLook) -> bool:
    """Whether the dancer of this look faces the viewer."""
    part = look.layout.dancer
    if part is None or look.layout.screen is not None:
        return False
    return is_front_view(look.camera or part.camera, default_look())

"""Writers of single pictures, by Pillow, and of GIF and WebP animations frame by frame, by `imageio.v3`.

Both are imported when something is written, so that other commands do not wait for them.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator
from itertools import chain, pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from PIL import Image

Pixels = NDArray[np.uint8]
UNCHANGED = 255  # the colour of a GIF's palette that shows the frame before


def picture_bytes(pixels: Pixels, suffix: Literal[".png", ".webp"] = ".png", **options: Any) -> bytes:
    """Return a picture (h, w), (h, w, 3) or (h, w, 4) as the bytes of a file. options : Pillow's for the format

    imageio would write the same bytes, but its import takes 0.2 s.
    """
    from PIL import Image

    out = io.BytesIO()
    Image.fromarray(pixels).save(out, suffix[1:], **options)
    return out.getvalue()


def read_palette(path: Path) -> Pixels:
    """Read a palette (256, 3) from a picture of its colours, row by row."""
    import imageio.v3 as iio

    return np.asarray(iio.imread(path, plugin="pillow", mode="RGB"), dtype=np.uint8).reshape(-1, 3)


def write_webp(path: Path, frames: Iterable[Pixels], count: int, fps: int) -> None:
    """Write a looping WebP animation of `count` frames (h, w, 3); one frame is in memory at a time."""
    _write(path, ".webp", _Frames(iter(frames), count), duration=1000.0 / fps, loop=0, quality=72, method=2)


def write_gif(path: Path, frames: Iterable[Pixels], palette: Pixels, fps: int) -> None:
    """Write a looping GIF of frames (h, w) of indices into a palette (256, 3), whose last colour is not used.

    Unchanged pixels are transparent: long runs of one colour, which compress well.
    """
    durations: list[int] = []  # GIFs count hundredths of a second: frames of 30 a second last 3, 4, 3 of them
    changes = _changes(frames, durations, fps)
    _write(
        path,
        ".gif",
        _Frames(changes, palette=palette),
        duration=durations,
        loop=0,
        transparency=UNCHANGED,
        optimize=False,
    )


def _changes(frames: Iterable[Pixels], durations: list[int], fps: int) -> Iterator[Pixels]:
    """Yield each frame with unchanged pixels as `UNCHANGED`; append its duration in milliseconds to the list."""
    frames = iter(frames)
    first = next(frames)
    for number, (before, now) in enumerate(pairwise(chain([first, first], frames))):
        durations.append(10 * (round(100 * (number + 1) / fps) - round(100 * number / fps)))
        yield now if number == 0 else np.where(now == before, np.uint8(UNCHANGED), now)


class _Frames(NamedTuple):
    """The frames of an animation. total : number of frames, 0 if not known"""

    pixels: Iterator[Pixels]
    total: int = 0
    palette: Pixels | None = None


def _write(path: Path, suffix: str, frames: _Frames, **options: Any) -> None:
    import imageio.v3 as iio

    plugin: Any = _streamed_plugin()
    with iio.imopen(path, "w", extension=suffix, plugin=plugin) as file:
        file.write(_film_class()(frames), **options)


def _streamed_plugin() -> Any:
    """Return imageio's Pillow plugin for frames from a stream; imageio's own needs all frames at once."""
    from imageio.plugins.pillow import PillowPlugin

    class StreamedPlugin(PillowPlugin):
        def write(self, film: Image.Image, **options: Any) -> None:  # type: ignore[override]
            film.save(self._request.get_file(), self.request.extension[1:], save_all=True, **options)

    return StreamedPlugin


def _film_class() -> Any:
    from PIL import Image

    class Film(Image.Image):
        """Frames for Pillow's writers: one image, whose `seek` shows the next frame."""

        is_animated = True

        def __init__(self, frames: _Frames) -> None:
            super().__init__()
            self._frames, self._at = frames, -1
            self.n_frames = frames.total
            self.seek(0)

        def seek(self, frame: int) -> None:
            if frame <= self._at:
                return  # writers go back to the first frame at the end
            pixels = next(self._frames.pixels, None)
            if pixels is None:
                raise EOFError
            self._at = frame
            self._show(pixels)

        def tell(self) -> int:
            return max(self._at, 0)

        def _show(self, pixels: Pixels) -> None:
            image = Image.fromarray(pixels)
            if self._frames.palette is not None:
                image.putpalette(self._frames.palette.tobytes())
            self.im, self._mode, self._size, self.palette = image.im, image.mode, image.size, image.palette

    return Film

"""A segment of a film that cannot be finished leaves nothing behind, whatever it is made of."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from dancetutor_cli.film.media.encoder import PICTURES, Encoding
from dancetutor_cli.film.work import segments
from dancetutor_cli.film.work.segments import PlanFile, Segment, remove_work, render_segment


class _NoFilm:
    """A film whose frames nobody looks at."""

    def frames(self, first: int, last: int) -> Any:
        return iter(range(first, last))


def _fails(write: Callable[[Path], None], error: BaseException) -> Callable[..., None]:
    def encode(frames: object, encoding: object, target: Path, first: int) -> None:
        write(target)
        raise error

    return encode


@pytest.fixture(autouse=True)
def no_film(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(segments, "load_film", lambda plan: _NoFilm())


@pytest.mark.parametrize("error", [OSError(errno.ENOSPC, "No space left on device"), KeyboardInterrupt(), SystemExit()])
def test_half_a_segment_is_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException) -> None:
    half = _fails(lambda target: (target.write_bytes(b"half"), None)[1], error)
    monkeypatch.setattr(segments, "encode_segment", half)
    whole = tmp_path / "segment_00000.mp4"
    whole.write_bytes(b"done before")
    segment = Segment(1, 24, 48, tmp_path / "segment_00001.mp4")
    with pytest.raises(type(error)):
        render_segment(print, PlanFile(tmp_path / "plan", ""), segment, Encoding("mp4", (64, 36), 30))
    assert [path.name for path in tmp_path.iterdir()] == ["segment_00000.mp4"]


def test_a_folder_is_removed_though_an_encoder_still_writes_into_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    work = tmp_path / "work"
    work.mkdir()
    (work / "plan.pickle").write_bytes(b"plan")
    late, rmdir = [work / "late.mp4"], os.rmdir

    def write_first(*place: Any, **options: Any) -> None:
        for file in late:
            file.write_bytes(b"an empty film of an encoder whose worker was ended")
        late.clear()
        rmdir(*place, **options)

    monkeypatch.setattr(os, "rmdir", write_first)
    remove_work(work)
    assert not work.exists() and not late


def test_its_own_pictures_are_removed_and_no_others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    frames = tmp_path / "frames"
    frames.mkdir()
    (frames / "frame_000023.png").write_bytes(b"of the segment before")
    (frames / "frame_000048.png").write_bytes(b"of the segment after")

    def two(target: Path) -> None:
        for number in (24, 25):
            (target / f"frame_{number:06d}.png").write_bytes(b"half")

    monkeypatch.setattr(segments, "encode_segment", _fails(two, OSError(errno.ENOSPC, "No space left on device")))
    with pytest.raises(OSError, match="No space left"):
        segment, encoding = Segment(1, 24, 48, frames), Encoding(PICTURES, (64, 36), 30)
        render_segment(print, PlanFile(tmp_path / "plan", ""), segment, encoding)
    assert sorted(path.name for path in frames.iterdir()) == ["frame_000023.png", "frame_000048.png"]

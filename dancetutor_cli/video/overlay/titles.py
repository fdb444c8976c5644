"""The words of the picture, from a song and a chart: in letters that the font has."""

from __future__ import annotations

from pathlib import Path

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.tempo import bpm_text
from dancetutor_cli.video.overlay.header import Words
from dancetutor_cli.video.overlay.text import Typeface, clean


def words_of(song: Song, chart: Chart, font: Path | None) -> Words:
    """The words of the picture, with the transliterated title where the font lacks the original's letters."""
    face = Typeface(font)
    title = _readable(face, song, song.title or song.path.stem, "TITLETRANSLIT")
    subtitle = _readable(face, song, song.subtitle, "SUBTITLETRANSLIT")
    artist = _readable(face, song, song.artist, "ARTISTTRANSLIT")
    credit = clean(chart.tags.get("CREDIT", ""))
    detail = f"{chart.steps_type} · {bpm_text(song, chart)} BPM"
    return Words(
        title=title or subtitle,
        artist=artist,
        badge=face.drawable(f"{chart.difficulty} {chart.meter}"),
        difficulty=chart.difficulty,
        detail=face.drawable(detail),
        credit=face.drawable(f"steps by {credit}") if credit else "",
        subtitle=subtitle if title else "",
    )


def _readable(face: Typeface, song: Song, text: str, tag: str) -> str:
    plain = face.drawable(text)
    other = song.tags.get(tag, "")
    return face.drawable(other) if "?" in plain and plain != text and other else plain


def title_warnings(song: Song, words: Words, font: Path | None) -> tuple[str, ...]:
    """Say so where letters of title or artist cannot be drawn."""
    missing = Typeface(font).missing(clean(song.title + song.artist))
    lost = "?" in words.title.replace("?", "", song.title.count("?")) or "?" in words.artist
    if not missing or not lost:
        return ()
    told = "no font here" if font is None else f"neither {font} nor a font of the system"
    return (f"{told} has letters for {missing[:12]!r} in title or artist; give one with --font FILE",)

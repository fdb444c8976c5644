"""Words in the picture: letters of every script, lines that fit, and parts that do not cover each other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from film_plans import DIRECTIONS, film_plan

from dancetutor_cli.film.clock import Pass
from dancetutor_cli.film.film import Film
from dancetutor_cli.film.layout import WIDE_PAD, FilmLook, load_layout
from dancetutor_cli.film.overlay import text
from dancetutor_cli.film.overlay.footer import Legend, LegendWords
from dancetutor_cli.film.overlay.header import Header, Words, WordsRoom
from dancetutor_cli.film.overlay.sprites import WordStyle, highway_style
from dancetutor_cli.film.overlay.text import Typeface, clean, fit_text, lay_in_lines, parts_of, system_fonts, wrap_words
from dancetutor_cli.run.languages import load_language
from dancetutor_cli.run.reading import config_names


def word_style() -> WordStyle:
    """The words of a film in English, in the built-in typeface."""
    return WordStyle(Typeface(), highway_style(), load_language())


@pytest.fixture
def fonts(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    """The fonts of a system, of which a test says what they are."""
    found: list[str] = []
    monkeypatch.setattr(text, "system_fonts", lambda: tuple(found))
    for cached in (text._font_of, text._runs):
        cached.cache_clear()
    yield found
    for cached in (text._font_of, text._runs):
        cached.cache_clear()


def test_titles_lose_controls_and_fold_what_no_font_has(fonts: list[str]) -> None:
    face = Typeface()
    assert clean("a\x1b[31mb\nc\u202e") == "a[31mb c"
    assert face.drawable("Café ～日本") == "Cafe ~??"
    long = face.fit("word " * 500, 20, 200)
    assert long.endswith("…") and face.width(long, 20) <= 200


def test_letters_the_built_in_font_lacks_come_from_the_system(fonts: list[str]) -> None:
    wide = next((path for path in system_fonts() if Path(path).name == "DejaVuSans.ttf"), None)
    if wide is None:
        pytest.skip("DejaVu Sans is not installed")
    assert Typeface().drawable("Ночь é") == "???? e"  # what a machine without fonts makes of it
    text._font_of.cache_clear()
    fonts.append(wide)
    face = Typeface()
    assert face.drawable("Ночь é") == "Ночь é" and face.missing("Ночь 日") == "日"
    assert text._runs(None, "Night")[0][0] is None  # what the built-in one can draw, it draws
    assert [part for part, _ in text._runs(None, "Ночь 1")] == [wide]  # one font for a line if there is one
    letters = [path for path, part in text._runs(None, "crossover ×4") if part.strip() != "×"]
    assert letters == [None, None], "a sign from elsewhere changes no letter"
    ink = face.sprite("Ночь", 30, (255, 255, 255))[..., 3]
    box = face.sprite("????", 30, (255, 255, 255))[..., 3]
    assert ink.shape[0] == box.shape[0] and (ink > 128).sum() > 200


def test_labels_wrap_before_they_become_small() -> None:
    face = Typeface()
    width = face.width("full crossover", 14)
    assert wrap_words(["full", "crossover"], 14, width + 1, face) == ["full crossover"]
    assert wrap_words(["full", "crossover"], 14, 0.7 * width, face) == ["full", "crossover"]
    lines, size = fit_text("full crossover", 14, 0.75 * width, face)
    assert lines == ["full", "crossover"] and size == 14


@pytest.mark.parametrize("room", [30, 55, 80, 300])
def test_labels_are_never_cut(room: int) -> None:
    face = Typeface()
    said = "heel down-right, toe centre, footswitch ×12"
    lines, size = fit_text(said, 16, room, face)
    assert " ".join(lines) == said and len(lines) <= 4
    assert max(face.width(line, size) for line in lines) <= room


def test_titles_shrink() -> None:
    face = Typeface()
    width = face.width("full crossover", 14)
    words, size = face.shrink("full crossover", 14, 0.9 * width)
    assert words == "full crossover" and size == pytest.approx(0.9 * 14, rel=0.03)
    words, size = face.shrink("full crossover", 14, 0.5 * width)
    assert words.endswith("…") and size == pytest.approx(0.8 * 14) and face.width(words, size) <= 0.5 * width


TITLES = [
    "Adore",
    "District of the Shadows",
    "Shiny Shiny (TANUKI -Half- Remix) Exclusive",
    "A Title of Many Words, A Title of Many Words",
    "高気圧ねこロック 〜ずっと一緒にいようね〜",
]
ARTISTS = ["x", "Somebody feat. Somebody Else & The Whole Others", "かめりあ feat. ななひら (Camellia feat. Nanahira)"]


@pytest.fixture
def written(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The lines that are written, in their order."""
    lines: list[str] = []
    ink = Typeface.sprite
    monkeypatch.setattr(
        Typeface, "sprite", lambda self, text, *a, **k: (lines.append(text), ink(self, text, *a, **k))[1]
    )
    return lines


@pytest.mark.parametrize("columns", [4, 8])
@pytest.mark.parametrize("name", [n for n in config_names("layouts") if load_layout(n).header])
@pytest.mark.parametrize(("title", "artist"), [*((t, "x") for t in TITLES), *(("Adore", a) for a in ARTISTS)])
def test_titles_and_artists_are_not_cut(name: str, title: str, artist: str, columns: int, written: list[str]) -> None:
    """They become smaller, then take more lines; nothing is left out, and nothing leaves what is beside her head."""
    layout = load_layout(name)
    words = Words(title, artist, "Hard 8", "Hard", "dance-double · 128-164 BPM", "steps by somebody")
    assert layout.header is not None
    box = layout.box("header", layout.size, columns)
    header = Header(words, box, layout.header.text, word_style(), WordsRoom(layout.header.room))
    all_of_it = "".join(written).replace(" ", "")
    assert all_of_it.startswith((title + artist + "Hard 8").replace(" ", ""))
    assert header.right <= box[0] + layout.header.room * (box[2] - box[0]) + 10 * layout.header.text
    assert header.top == box[1]


@pytest.mark.parametrize(
    ("title", "subtitle", "lines"),
    [
        ("Adore", "(Mix)", ["Adore (Mix)"]),
        ("A Title of Words", "Simple Crossovers Edition", ["A Title of Words", "Simple Crossovers Edition"]),
        ("THAT'S THE WAY (I LIKE IT)", "", ["THAT'S THE WAY", "(I LIKE IT)"]),
        ("[x] Words of a Title (a) (b)", "", ["[x] Words of a Title", "(a) (b)"]),
        ("Many Words of a Title (a)", "of Mine", ["Many Words", "of a Title (a)", "of Mine"]),
        ("(all of it stands in brackets)", "", ["(all of it stands", "in brackets)"]),
    ],
)
def test_a_subtitle_stands_below_its_title_and_smaller(
    title: str, subtitle: str, lines: list[str], written: list[str]
) -> None:
    words = Words(title, "x", "Hard 8", "Hard", "", subtitle=subtitle)
    header = Header(words, (0, 0, 270, 200), 1.0, word_style())
    assert written[: len(lines)] == lines and written[len(lines)] == "x"
    if len(lines) > 1 and title != "(all of it stands in brackets)":
        assert header.lines[len(lines) - 1][0].shape[0] < header.lines[0][0].shape[0]


def test_lines_are_about_as_long_as_each_other() -> None:
    face = Typeface()
    text = "La Troupe de Mozart, L'Opéra Rock"
    width = face.width("La Troupe de Mozart, L'Opéra", 20) + 1
    assert fit_text(text, 20, width, face, 2) == (["La Troupe de Mozart,", "L'Opéra Rock"], 20)


def test_what_does_not_fit_ends_at_a_word(written: list[str]) -> None:
    style = word_style()
    words = Words("Many Long Words of a Song " * 12, "Very Many Artists, " * 9, "Hard 8", "Hard", "", "steps by x")
    header = Header(words, (0, 0, 280, 200), 1.0, style)
    title, artist = written[:4], written[4:6]
    assert written[6] == "Hard 8" and len(written) == 7  # no room for the credit
    for lines, whole in ((title, words.title), (artist, words.artist)):
        assert lines[-1].endswith("…") and not any("…" in line for line in lines[:-1])
        shown = " ".join(lines)[:-1]
        assert whole.startswith(shown) and whole[len(shown)] in " ,"
    assert header.right <= 286


def test_scripts_without_blanks_break_between_letters_but_not_before_what_closes() -> None:
    assert parts_of("Ab cd") == ["Ab", " cd"]
    assert parts_of("") == [""]
    assert parts_of("ねこ（ロック）！ x") == ["ね", "こ", "（ロッ", "ク）！", " x"]
    assert "".join(parts_of("高気圧ねこロック 〜ずっと")) == "高気圧ねこロック 〜ずっと"
    face = Typeface()
    title = "高気圧ねこロック"
    lines = lay_in_lines(title, 20, face.width(title, 20) / 2 + 1, face, 2)
    assert len(lines) == 2 and "".join(lines) == title


def test_a_title_of_a_stranger_is_not_tried_in_every_size(monkeypatch: pytest.MonkeyPatch) -> None:
    """Titles may be 100 kB long: one measuring of the line was repeated 30,000 times."""
    asked = []
    width = Typeface.width
    monkeypatch.setattr(Typeface, "width", lambda self, text, size: (asked.append(text), width(self, text, size))[1])
    words = Words("a " * 50_000, "", "Hard 8", "Hard", "")
    Header(words, (0, 0, 740, 200), 1.0, word_style())
    assert len(asked) < 100


def test_what_does_not_fit_beside_the_badge_stands_below_it() -> None:
    style = word_style()
    words = Words("Possession", "", "Challenge 18", "Challenge", "dance-double · 184-371 BPM")
    for width, lines in ((700, 3), (260, 3)):
        header = Header(words, (0, 0, width, 200), 1.0, style)
        assert len(header.lines) == lines
        (_, _, badge), (ink, x, y) = header.lines[1], header.lines[2]
        assert (y > badge + 20) == (width == 260)
        assert x + ink.shape[1] <= width + 8


def test_a_longer_line_is_as_wide_as_its_letters() -> None:
    face = Typeface()
    ones, many = face.width("o", 9), face.width("o" * 40, 9)
    assert many == pytest.approx(40 * ones, rel=0.02)  # letters on whole pixels would add up to something else


@pytest.mark.parametrize("columns", [4, 8])
@pytest.mark.parametrize("name", config_names("layouts"))
def test_parts_of_a_layout_do_not_cover_each_other(name: str, columns: int) -> None:
    layout = load_layout(name)
    names = [n for n in ("dancer", "highway", "calls", "feet", "runs", "next", "progress") if getattr(layout, n)]
    if layout.screen is not None:
        names.remove("highway")  # it is shown in her room
    if layout.feet is not None and columns > WIDE_PAD and not layout.feet.wide:
        names.remove("feet")
    boxes = {n: layout.box(n, layout.size, columns) for n in names}
    if layout.screen is not None:  # words stand in her room, beside her
        (left, top, right, bottom), region = boxes["dancer"], np.array(layout.region(columns))
        wide, high = right - left, bottom - top
        a, b, c, d = (region * [wide, high, wide, high] + [left, top, left, top]).tolist()
        boxes["dancer"] = round(a), round(b), round(c), round(d)
    for (one, a), (other, b) in combinations(boxes.items(), 2):
        apart = a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1]
        assert apart or {one, other} in ({"calls", "dancer"}, {"feet", "dancer"}), f"{one} and {other}"


@pytest.mark.parametrize("name", ["side-by-side", "vertical", "dancer"])
@pytest.mark.parametrize("columns", [4, 10])
def test_a_legend_of_five_lines_leaves_the_songs_words_alone(name: str, columns: int) -> None:
    layout = load_layout(name)
    part, face = layout.legend, Typeface()
    assert part is not None
    box = layout.box("legend", layout.size, columns)
    names = {0: "left foot", 1: "right foot", 2: "left hand", 3: "right hand"}
    legend = Legend(LegendWords(names, "she faces you"), box, part.text, face)
    assert min(y for _, _, y in legend.lines) >= box[1] - 10 * part.text


@pytest.mark.parametrize("layout", ["side-by-side", "vertical", "dancer"])
def test_the_legend_stands_below_many_words(layout: str) -> None:
    look = FilmLook(load_layout(layout), load_layout(layout).size)
    words = Words(TITLES[3] + " " + TITLES[2], ARTISTS[1], "Hard 8", "Hard", "dance-double · 128-164 BPM", "steps by x")
    plan = replace(film_plan(np.arange(1.0, 4.0)), look=look, directions=DIRECTIONS * 2, words=words)
    film = Film(plan)
    assert film.placement.header is not None and film.placement.legend is not None
    (left, top, _, bottom), height = film.placement.legend.boxes[0], look.size[1]
    assert bottom < height
    for one in (box for part in film.placement.header.parts for box in part.boxes):
        assert one[3] <= top + 12 * film.scale or one[0] >= left + film.placement.legend.lines[0][0].shape[1]


def test_the_legend_has_hands_only_where_some_are_shown() -> None:
    look = FilmLook(load_layout("side-by-side"), load_layout("side-by-side").size)
    plan = replace(film_plan(np.array([1.0, 40.0])), look=look)
    plan = replace(plan, notes=replace(plan.notes, limb=np.array([0, 2], np.int8)))
    counts = []
    for start, end in ((0.0, 5.0), (38.0, 42.0), (34.0, 37.0)):
        clock = replace(plan.clock, passes=(Pass(start, end, 1.0),))
        legend = Film(replace(plan, clock=clock)).placement.legend
        assert legend is not None
        counts.append(len(legend.lines))
    assert counts[1] == counts[2] == counts[0] + 2

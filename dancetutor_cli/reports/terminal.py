"""Text for terminals: safe characters, width and colours; diffs, joined warnings, tables of failures, progress."""

from __future__ import annotations

import os
import re
import sys
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import TracebackType
from typing import IO, TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rich.color import ColorSystem
    from rich.console import Console
    from rich.progress import Progress, TaskID


# Text from untrusted files, made safe to print: no control characters, no escapes, one line.

# Controls (C0, DEL, C1), line and paragraph separators, and characters that change the direction of text.
_UNSAFE = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029\u200e\u200f\u202a-\u202e\u2066-\u2069\ufeff\ufffe\uffff]+")


def safe(text: str) -> str:
    """Return `text` on one line, without characters that move a cursor, change a colour or hide text."""
    return _UNSAFE.sub(" ", text).encode("utf-8", "replace").decode("utf-8").strip()


def safe_path(path: str) -> str:
    """Return a path for printing: as by `safe`, and bytes that are not UTF-8 become "�"."""
    try:
        name = os.fsencode(path)
    except UnicodeEncodeError:  # a name from a cache, written under an encoding with more letters
        name = path.encode("utf-8", "surrogateescape")
    return _UNSAFE.sub("?", name.decode("utf-8", "replace"))


# The width and colours of a stream; rich is used only if the stream may be a terminal.

_WITHOUT_TERMINAL = 100  # characters of a line
_SAY_MORE = ("FORCE_COLOR", "TTY_COMPATIBLE", "COLUMNS")  # environment variables that rich obeys for any stream


class Terminal(NamedTuple):
    """The properties of an output stream.

    width : characters of a line; colours : None for no colours; plain : whether it shows only ASCII characters
    """

    width: int = _WITHOUT_TERMINAL
    colours: ColorSystem | None = None
    plain: bool = False

    def paint(self, text: str, style: str) -> str:
        """Return text in a style of rich, such as "bold red"; unchanged if there are no colours."""
        if self.colours is None or not text:
            return text
        from rich.style import Style

        return Style.parse(style).render(text, color_system=self.colours)


def terminal_of(stream: IO[str]) -> Terminal:
    """Return the properties of a stream. It has no colours if it is not a terminal, or if NO_COLOR is set."""
    plain = not can_encode(stream, "─")
    if not stream.isatty() and not any(name in os.environ for name in _SAY_MORE):
        return Terminal(plain=plain)
    console = _console(stream)
    return Terminal(console.width, _colours(console), plain)


def can_encode(stream: IO[str], text: str) -> bool:
    """Whether a stream's encoding has all characters of a text."""
    try:
        text.encode(getattr(stream, "encoding", None) or "utf-8")
    except UnicodeEncodeError:
        return False
    return True


def _console(stream: IO[str]) -> Console:
    from rich.console import Console

    console = Console(file=stream, markup=False, emoji=False, highlight=False)
    if console.is_terminal and not os.environ.get("NO_COLOR"):
        return console
    width = None if console.is_terminal or os.environ.get("COLUMNS") else _WITHOUT_TERMINAL
    return Console(file=stream, markup=False, emoji=False, highlight=False, color_system=None, width=width)


def _colours(console: Console) -> ColorSystem | None:
    from rich.color import ColorSystem

    systems = {
        "standard": ColorSystem.STANDARD,
        "256": ColorSystem.EIGHT_BIT,
        "truecolor": ColorSystem.TRUECOLOR,
    }
    return systems.get(console.color_system or "") if not console.legacy_windows else None


# A unified diff for people, in colours if the terminal has them.

_STYLES = {"+": "green", "-": "red", "@": "cyan"}


def coloured(diff: Iterable[str]) -> Iterator[str]:
    """Yield the lines of a diff, in colours if standard output has them."""
    paint = terminal_of(sys.stdout).paint
    for line in diff:
        style = _STYLES.get(line[:1])
        yield paint(line, style) if style else line


# The table of failures of a run over many charts.


def failures_table(rows: Iterable[tuple[str, str, str]]) -> None:
    """Print rows of (file, chart, error) as a table to standard error."""
    from rich.console import Console
    from rich.table import Table

    table = Table(title="Failed", title_justify="left")
    for name in ("file", "chart", "why"):
        table.add_column(name, overflow="fold")
    for row in rows:
        table.add_row(*(safe(cell) for cell in row))
    Console(stderr=True, markup=False, highlight=False).print(table)


# Warnings of a run over many files: a warning that several files share is one line, with a count and the first names.

_NAMED = 4  # limit of the files that a warning names
_PLACE = re.compile(r"(:\d+)*:\s*")
_CHART = re.compile(r"[a-z]+-[a-z-]+ \S+ -?\d+: ")  # "dance-single Hard 9: "
_NUMBER = re.compile(r"\d+")


class JoinedWarnings:
    """The warnings of a run, collected for its end.

    every : whether each warning is a line of its own
    """

    def __init__(self, *, every: bool = False) -> None:
        self._every = every
        self._kinds: dict[tuple[Path, str] | str, list[tuple[Path, str]]] = {}

    def add(self, path: Path, warning: str) -> None:
        """Add a warning about a file, which may begin with the file's name; repeated warnings are counted."""
        if not warning.startswith(str(path)):
            warning = f"{path}: {warning}"
        kind = _NUMBER.sub("0", _CHART.sub("", _PLACE.sub("", warning.removeprefix(str(path)), count=1)))
        self._kinds.setdefault((path, warning) if self._every else kind, []).append((path, warning))

    def lines(self) -> Iterator[str]:
        """Yield the first warning of each kind, with the other files that have the same one."""
        for found in self._kinds.values():
            path, warning = found[0]
            others = list(dict.fromkeys(other for other, _ in found if other != path))
            more = ""
            if others:
                named = others if len(others) <= _NAMED else others[: _NAMED - 1]
                names = ", ".join(safe_path(str(other)) for other in named)
                rest = f" and {len(others) - len(named)} others" if len(named) < len(others) else ""
                more = f"; the same for {len(others)} more: {names}{rest}"
            elif len(found) > 1:
                times = "once" if len(found) == 2 else f"{len(found) - 1} times"
                more = f"; the same {times} more in this file"
            yield f"warning: {safe(warning)}{more}" + (" (-v prints each)" if more and not self._every else "")


# The progress of a film: a bar with speed and remaining time at a terminal, a line from time to time elsewhere.

EVERY = 30.0  # seconds between lines if there is no terminal
ENOUGH = 0.03  # share of a film (at least a second of it) that must be drawn before the speed is known


class FilmProgress:
    """The progress of one film on standard error; nothing if `quiet`. Use it as a context manager."""

    def __init__(self, name: str, quiet: bool = False) -> None:
        self.name, self.quiet = name, quiet
        self.terminal = sys.stderr.isatty() and not quiet
        self.frames = self.fps = self.done = 0
        self.began = self.last_report = 0.0
        self.early = 0  # frames that were drawn before the speed was measured
        self.bar: Progress | None = None
        self.task: TaskID | None = None

    def __enter__(self) -> FilmProgress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.bar is not None:
            self.bar.stop()

    def begin(self, frames: int, fps: int) -> None:
        """Start the clock. frames : number of frames of the film; fps : frames per second"""
        self.frames, self.fps = frames, fps
        self.began = self.last_report = time.monotonic()
        if self.terminal:
            self._open_bar()

    def _open_bar(self) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            TaskProgressColumn(),
            TextColumn("{task.fields[speed]}"),
            TimeRemainingColumn(compact=True),
        )
        self.bar = Progress(*columns, console=Console(stderr=True), transient=True)
        self.bar.start()
        self.task = self.bar.add_task(self.name, total=self.frames, speed="")

    def add(self, frames: int) -> None:
        """Add frames that will be drawn."""
        self.frames += frames
        if self.bar is not None and self.task is not None:
            self.bar.update(self.task, total=self.frames)

    def say(self, line: str) -> None:
        """Write a line without breaking the bar."""
        if self.bar is not None:
            self.bar.console.print(line, markup=False, highlight=False)
        else:
            sys.stderr.write(f"{line}\n")
            sys.stderr.flush()

    def advance(self, frames: int) -> None:
        """Count more frames as drawn, and show the progress."""
        now = time.monotonic()
        if not self.done:  # until now, workers have started and compiled, so their speed is not known
            self.began, self.early = now, frames
        self.done += frames
        speed = self._speed(now)
        if self.bar is not None and self.task is not None:
            self.bar.update(self.task, advance=frames, speed="" if speed is None else f"{speed:.2f}x")
        elif not self.quiet and self.fps and self.done and now - self.last_report >= EVERY:
            self.last_report = now
            line = f"{self.name}: {self.done / self.fps:.0f} of {self.frames / self.fps:.0f} s done"
            if speed is not None:
                line += f", {speed:.2f}x, {(self.frames - self.done) / self.fps / speed:.0f} s left"
            sys.stderr.write(f"{line}\n")
            sys.stderr.flush()

    def _speed(self, now: float) -> float | None:
        """Return the seconds of film per second; None until enough is drawn."""
        drawn = self.done - self.early
        if not self.fps or drawn < max(self.fps, ENOUGH * self.frames) or now <= self.began:
            return None
        return drawn / self.fps / (now - self.began)


FIXED_BLANK = "\0"  # a blank at which `cut` does not end a line
_COLOUR = re.compile("\x1b\\[[0-9;]*m")
_LONGEST_WORD = 20


def cut(line: str, width: int) -> str:
    """Return the words of a line that fit in `width` characters without colours. Long words, as of paths, are cut."""
    plain = len(_COLOUR.sub("", line))
    if plain > width:
        line = line[: width - 1 + len(line) - plain]
        words, _, rest = line.rpartition(" ")
        line = f"{words.rstrip(';,:')} …" if words.strip() and len(rest) < _LONGEST_WORD else f"{line}…"
    return line.replace(FIXED_BLANK, " ")

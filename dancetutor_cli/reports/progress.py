"""The progress of a film: a bar with speed and remaining time at a terminal, a line from time to time elsewhere."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

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
            self.say(line)

    def _speed(self, now: float) -> float | None:
        """Return the seconds of film per second; None until enough is drawn."""
        drawn = self.done - self.early
        if not self.fps or drawn < max(self.fps, ENOUGH * self.frames) or now <= self.began:
            return None
        return drawn / self.fps / (now - self.began)

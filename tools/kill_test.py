"""End the program at random moments: `make kill-test` (KILLS=300). Nothing may be lost, and no half-made file may stay.

annotate: the chart file is the old one or the new one, and a second run ends as an undisturbed one does. render: the
film is not there or whole, and a second run makes it. analyze: what the caches hold gives the same report as before.
A program that is told to end (SIGINT, SIGTERM) prints no traceback.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from dancetutor_cli.run.reading import charts_path

SONG = charts_path() / "two_left_feet" / "two_left_feet.ssc"
FILM = ("--steps-type", "dance-single", "--difficulty", "hard", "--section", "m3:m4", "--size", "96x64", "--fps", "10")
SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT) if os.name != "nt" else (signal.SIGTERM,)


class KillTest:
    """One folder with a song; `try_once` ends one command in it at a random moment and looks at what is left."""

    def __init__(self, folder: Path, seed: int, names: Sequence[str]) -> None:
        self.chance = random.Random(seed)
        self.song = folder / "song" / SONG.name
        self.film = folder / "x.mp4"
        self.environment = {**os.environ, "DANCETUTOR_CACHE": str(folder / "cache"), "PYTHONUNBUFFERED": "1"}
        self.song.parent.mkdir()
        self.old = SONG.read_bytes()
        self.commands = {
            "annotate": ("annotate", str(self.song)),
            "render": ("render", str(self.song), *FILM, "-o", str(self.film), "--jobs", "2"),
            "analyze": ("analyze", str(self.song), "--format", "jsonl"),
        }
        self.seconds: dict[str, float] = {}
        self.wanted: dict[str, bytes] = {}
        for name in names:
            for _ in range(2):  # the first run compiles
                self.reset()
                begin = time.monotonic()
                ran = self.run(name)
                self.seconds[name] = time.monotonic() - begin
            self.wanted[name] = self.result(name, ran)

    def reset(self) -> None:
        """Restore the song and remove everything else."""
        shutil.rmtree(self.song.parent)
        self.song.parent.mkdir()
        self.song.write_bytes(self.old)
        self.film.unlink(missing_ok=True)
        shutil.rmtree(self.environment["DANCETUTOR_CACHE"], ignore_errors=True)

    def run(self, name: str) -> subprocess.CompletedProcess[bytes]:
        """Run a command to its end."""
        command = [sys.executable, "-m", "dancetutor_cli", *self.commands[name]]
        return subprocess.run(command, capture_output=True, env=self.environment, timeout=300, check=False)

    def result(self, name: str, ran: subprocess.CompletedProcess[bytes]) -> bytes:
        """What a whole run of a command leaves: a file, or what it prints."""
        if name == "analyze":
            return ran.stdout
        file = self.song if name == "annotate" else self.film
        return file.read_bytes()

    def try_once(self, name: str) -> str | None:
        """End a command at a random moment; what was wrong then, or None."""
        self.reset()
        how = self.chance.choice(SIGNALS)
        after = self.chance.uniform(0.02, 1.1) * self.seconds[name]
        command = [sys.executable, "-m", "dancetutor_cli", *self.commands[name]]
        started = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env=self.environment, start_new_session=True
        )
        time.sleep(after)
        started.send_signal(how)
        try:
            said = started.communicate(timeout=60)[1].decode("utf-8", "replace")
        except subprocess.TimeoutExpired:
            os.killpg(started.pid, signal.SIGKILL)
            return f"{how.name} after {after:.3f} s: did not end within a minute"
        wrong = self._left(name) or self._said(said, how, after)
        return None if wrong is None else f"{name}: {how.name} after {after:.3f} s: {wrong}"

    def _said(self, said: str, how: signal.Signals, after: float) -> str | None:
        # Python itself imports for a moment before the program has a say.
        if how is signal.SIGKILL or after < 0.25:
            return None
        told = [line for line in said.splitlines() if "Traceback" in line or "Exception ignored" in line]
        return f"prints {told[0]!r}" if told else None

    def _left(self, name: str) -> str | None:
        wanted = self.wanted[name]
        if name == "annotate" and self.song.read_bytes() not in (self.old, wanted):
            return "the chart file is neither the old nor the new one"
        if name == "render" and self.film.exists() and self.film.read_bytes() != wanted:
            return "half a film is left"
        if name != "annotate" and self.song.read_bytes() != self.old:
            return "the chart file has changed"
        if self.result(name, self.run(name)) != wanted:
            return "a second run ends otherwise than an undisturbed one"
        if name == "annotate" and [path.name for path in self.song.parent.iterdir()] != [self.song.name]:
            return "something is left beside the chart file"
        return None


def main() -> int:
    """Run as a program; exit status 1 if something was lost."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--commands", nargs="+", default=["annotate", "render", "analyze"])
    given = parser.parse_args()
    tried: Counter[str] = Counter()
    wrong: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        test = KillTest(Path(folder), given.seed, given.commands)
        for number in range(given.count):
            name = given.commands[number % len(given.commands)]
            tried[name] += 1
            if found := test.try_once(name):
                wrong.append(found)
                print(found, flush=True)
    print(f"{given.count} ends ({', '.join(f'{n} {name}' for name, n in tried.items())}): {len(wrong)} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

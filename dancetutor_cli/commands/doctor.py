"""`dancetutor doctor`: a line for each thing that rendering needs, and how to repair what is missing."""

from __future__ import annotations

import shutil
import sys
import textwrap
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import click

from dancetutor_cli.commands.option_groups import GroupedCommand
from dancetutor_cli.run.errors import DancetutorError, UnavailableError, install_command, plural
from dancetutor_cli.run.foreign_text import json_without_commands

# The checks of `doctor`: each examines one thing that rendering needs, and never raises.

GIGABYTE = 1e9
_NOTHING = "nothing compiled yet; the first film takes about 30 s longer"
_ROOM = 2 * GIGABYTE  # enough free space: a long song at best quality needs less


@dataclass(frozen=True, slots=True)
class Check:
    """The result of a check. state : "ok", "without" (optional) or "broken"; remedy : what to do, or ""."""

    name: str
    state: str
    message: str
    remedy: str = ""


def examine() -> list[Check]:
    """Return the results of all checks, in the order in which a render needs the things."""
    checks = [_guarded("cpu renderer", _cpu), _guarded("gl renderer", _gl), _guarded("physics", _physics)]
    checks.append(_guarded("ffmpeg", _ffmpeg))
    if checks[-1].state == "ok":
        checks += [_guarded(f"encoder {name}", lambda n=name: _encoder(n)) for name in ENCODERS]  # type: ignore[misc]
        checks.append(_guarded("speed change", _rubberband))
    return [*checks, _guarded("numba cache", _cache), _guarded("font", _font), _guarded("disk", _disk)]


# name of --encoder -> ffmpeg's encoder
ENCODERS = {"x264": "libx264", "nvenc": "h264_nvenc", "vaapi": "h264_vaapi", "aac": "aac"}
_NEEDED = ("x264", "aac")
_OPTIONAL = {
    "nvenc": "an NVIDIA GPU and its driver; x264 needs neither",
    "vaapi": "a GPU with a VA driver; x264 needs neither",
}
# Scripts of titles, with letters that show whether a font has the script.
SCRIPTS = {"Western": "éßø", "Cyrillic": "Жя", "Japanese": "あ日", "Korean": "한", "Chinese": "们"}


def _guarded(name: str, look: Callable[[], Check]) -> Check:
    try:
        return look()
    except (DancetutorError, OSError, ImportError, RuntimeError) as error:
        return Check(name, "broken", " ".join(str(error).split()), "install dancetutor again")


def _cpu() -> Check:
    from importlib.metadata import version

    from dancetutor_cli.run.kernels.compiling import numba

    return Check("cpu renderer", "ok", f"numba {numba.__version__}, llvmlite {version('llvmlite')}")


def _gl() -> Check:
    from dancetutor_cli.film.scene.gl.available import gpu_device, require_gl

    try:
        require_gl()
    except UnavailableError as error:
        message, _, remedy = str(error).partition(". ")
        return Check("gl renderer", "without", message, remedy)
    device = gpu_device()
    if device is None:
        return Check("gl renderer", "ok", "OpenGL without a GPU; auto takes cpu, which is faster")
    return Check("gl renderer", "ok", f"OpenGL on GPU {device} through EGL")


def _physics() -> Check:
    from dancetutor_cli.dance.physics.style import engine, is_installed

    if not is_installed():
        return Check("physics", "without", "no engine for --style and retarget", install_command("physics"))
    return Check("physics", "ok", f"MuJoCo {engine().__version__}")


def _ffmpeg() -> Check:
    import subprocess

    from dancetutor_cli.run.ffmpeg import MEND, executable

    try:
        path = executable()
    except UnavailableError:
        return Check("ffmpeg", "broken", "none found", MEND)
    command = [path, "-version"]
    output = subprocess.run(
        command, capture_output=True, check=True, timeout=20, encoding="utf-8", errors="replace"
    ).stdout
    version = output.splitlines()[0].removeprefix("ffmpeg version ").split()[0]
    return Check("ffmpeg", "ok", f"{version}, {'of imageio-ffmpeg' if 'imageio_ffmpeg' in str(path) else path}")


def _encoder(name: str) -> Check:
    from dancetutor_cli.film.media.encoder import encoder_problem
    from dancetutor_cli.run.ffmpeg import MEND

    label = f"encoder {name}"
    failure = encoder_problem(ENCODERS[name])
    if failure is None:
        return Check(label, "ok", f"{ENCODERS[name]} encodes a frame")
    if name in _NEEDED:
        return Check(label, "broken", failure, MEND)
    return Check(label, "without", failure.split(";")[0], _OPTIONAL.get(name, ""))


def _rubberband() -> Check:
    import numpy as np

    from dancetutor_cli.film.media.sound import RATE, stretch

    stretch(np.zeros((RATE // 4, 2), dtype=np.float32), 0.5)
    return Check("speed change", "ok", "rubberband changes the speed and keeps the pitch")


def _cache() -> Check:
    from dancetutor_cli.run.kernels.stored_code import VARIABLE, count_kernels, kernel_folder
    from dancetutor_cli.run.reading import PACKAGE

    folder = kernel_folder()
    target = folder.root or PACKAGE
    counts = {place: count_kernels(place) for place in dict.fromkeys((target, PACKAGE))}
    usable = {place: fitting for place, (fitting, _) in counts.items() if fitting}
    lines = [f"{plural(count, 'kernel')} in {place}" for place, count in usable.items()] or [_NOTHING]
    if not folder.is_writable:
        lines.append("and none can be stored")
    elif target not in usable:
        lines.append(f"new ones go into {target}")
    if other := sum(others for _, others in counts.values()):
        lines.append(f"{plural(other, 'kernel')} for another version of Python, numba or llvmlite: not used")
    message = ", ".join(lines)
    if folder.fault:
        remedy = f"set {VARIABLE} to a folder that can be written, then dancetutor warmup"
        return Check("numba cache", "without", f"{folder.fault}; {message}", remedy)
    return Check("numba cache", "ok" if usable else "without", message, "" if usable else "dancetutor warmup")


def _font() -> Check:
    from dancetutor_cli.film.overlay.text import Typeface, system_fonts

    missing = Typeface().missing("".join(SCRIPTS.values()))
    if not missing:
        others = [Path(path).stem for path in system_fonts()]
        return Check("font", "ok", "Pillow's" + (f", for other letters {', '.join(others[:3])}" if others else ""))
    lost = ", ".join(name for name, letters in SCRIPTS.items() if set(letters) & set(missing))
    remedy = "install Noto Sans CJK and DejaVu Sans, or use --font FILE"
    return Check("font", "without", f"no letters for {lost}", remedy)


def _disk() -> Check:
    free = shutil.disk_usage(Path.cwd()).free
    message = f"{free / GIGABYTE:.1f} GB free in {Path.cwd()}"
    if free < _ROOM:
        return Check("disk", "without", message, "free some space, or write to another disk with -o")
    return Check("disk", "ok", message)


WIDTH = 80  # columns
_SHOWN = {"without": "missing"}  # states that have another word in the table than in the JSON


@click.command(cls=GroupedCommand)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def command(as_json: bool) -> None:
    """Check renderers, encoders, caches, fonts and disk, and print how to repair what is missing.

    Exit status: 0 films can be made, 2 they cannot.
    """
    checks = examine()
    if as_json:
        import json

        rows = [{"name": c.name, "state": c.state, "message": c.message, "mend": c.remedy} for c in checks]
        text = json.dumps({"schema": 1, "checks": rows}, ensure_ascii=False, indent=1)
        click.echo(json_without_commands(text))
    else:
        width = max(len(c.name) for c in checks)
        for check in checks:
            _print_entry(
                f"{_SHOWN.get(check.state, check.state):<7} {check.name:<{width}}  ", check.message.rstrip(".")
            )
            if check.remedy:
                _print_entry(" " * (width + 10), f"to repair: {check.remedy}")
    if any(check.state == "broken" for check in checks):
        sys.exit(2)


def _print_entry(head: str, text: str) -> None:
    """Print a line, with further lines below its text if that is long; paths are never broken."""
    lines = textwrap.wrap(text, WIDTH - len(head), break_long_words=False, break_on_hyphens=False)
    for number, line in enumerate(lines):
        click.echo(f"{head if number == 0 else ' ' * len(head)}{line}")

"""Write the tables of docs that commands measure: `python tools/doc_figures.py [NAME...]`, all if none is named.

A table stands between `<!-- figures: NAME -->` and `<!-- end of figures -->`. Names: costs (of presets), motion (the
report of the demo song), speed (processor time of the commands on this machine, each in a process of its own).
"""

from __future__ import annotations

import importlib.util
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DEMO = "charts/two_left_feet/two_left_feet.ssc"
HARD = ("--index", "3")
SHOWN = (
    "contact error", "contacts missed", "plant slide", "penetration", "flight gravity off by", "ground force, largest",
    "balance", "frames past joint limits", "limb in torso", "leg in leg",
)  # fmt: skip


def command(*arguments: str) -> float:
    """Run the command on the demo song; processor seconds, user and system."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with tempfile.TemporaryDirectory() as cache:  # nothing is kept from an earlier run
        call, environment = (
            [sys.executable, "-m", "dancetutor_cli", *arguments],
            {**os.environ, "DANCETUTOR_CACHE": cache},
        )
        subprocess.run(call, cwd=ROOT, check=True, capture_output=True, env=environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def motion() -> str:
    """Figures of `animate --report` for the demo's hard chart."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command("animate", DEMO, *HARD, "-o", f"{folder}/a.npz", "--report", str(report))
        figures = {one["name"]: one for one in json.loads(report.read_text("utf-8"))["figures"]}
    lines = ["| figure | here | goal |", "| --- | ---: | ---: |"]
    for name in SHOWN:
        one = figures[name]
        unit = f" {one['unit']}" if one["unit"] else ""
        bound = "at least " if one["at_least"] else "at most " if one["goal"] else ""
        lines.append(f"| {name} | {round(one['value'], 3):.3g}{unit} | {bound}{one['goal']:g}{unit} |")
    return "\n".join(lines) + "\n"


def speed() -> str:
    """Processor seconds of the commands, compiled kernels and an empty cache of results; the least of three runs."""
    with tempfile.TemporaryDirectory() as folder:
        calls = {
            "`analyze`, one song with six charts": ("analyze", DEMO, "--no-cache", "--exit-zero"),
            "`animate`, 42 s of dance": ("animate", DEMO, *HARD, "-o", f"{folder}/a.glb"),
            "`page`, one chart": ("page", DEMO, *HARD, "-o", f"{folder}/a.html", "-q"),
            "`render`, 2 s at 1280x720": ("render", DEMO, *HARD, "--section", "20:22", "-o", f"{folder}/a.mp4", "-q"),
        }
        lines = ["| command, on the demo song | processor seconds |", "| --- | ---: |"]
        for name, call in calls.items():
            lines.append(f"| {name} | {min(command(*call) for _ in range(3)):.1f} |")
    return "\n".join(lines) + "\n"


def costs() -> str:
    """The tables of the presets."""
    spec = importlib.util.spec_from_file_location("cost_tables", ROOT / "research" / "cost_tables.py")
    assert spec is not None and spec.loader is not None
    tool = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tool)
    tables: str = tool.tables()
    return tables


FIGURES: dict[str, tuple[str, Callable[[], str]]] = {
    "costs": ("cost-model.md", costs),
    "motion": ("motion.md", motion),
    "speed": ("performance.md", speed),
}


def between(text: str, name: str) -> str:
    """The text of a page under this name."""
    found = re.search(rf"<!-- figures: {name} -->\n(.*?)<!-- end of figures -->", text, re.S)
    assert found, f"no figures '{name}' there"
    return found[1]


def main() -> None:
    """Write those that are named, or all."""
    for name in sys.argv[1:] or FIGURES:
        page, make = FIGURES[name]
        path = ROOT / "docs" / page
        text = path.read_text("utf-8")
        begin, end = f"<!-- figures: {name} -->\n", "<!-- end of figures -->"
        path.write_text(text.replace(begin + between(text, name) + end, begin + make() + end), encoding="utf-8")
        print(f"docs/{page}: {name}")


if __name__ == "__main__":
    main()

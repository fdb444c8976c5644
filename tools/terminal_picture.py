"""A picture of what a command prints: `terminal_picture.py OUT.svg [--title WORDS] -- COMMAND...`; for docs.

Colours are the command's own. The SVG names no font of the net: it is shown in whatever fixed one there is.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
from pathlib import Path

from rich._export_format import CONSOLE_SVG_FORMAT
from rich.console import Console
from rich.text import Text

WIDTH = 110
FONT_FACE = re.compile(r"@font-face \{\{.*?\}\}\s*", re.DOTALL)


def main() -> None:
    """Run the command and write the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--title", default="")
    parser.add_argument("--lines", type=int, default=40)
    parser.add_argument("command", nargs="+")
    asked = parser.parse_args()
    environment = {**os.environ, "FORCE_COLOR": "1", "COLUMNS": str(WIDTH), "TERM": "xterm-256color"}
    done = subprocess.run(asked.command, capture_output=True, encoding="utf-8", env=environment, check=False)
    if done.returncode not in (0, 1):
        sys.exit(done.stderr)
    console = Console(record=True, width=WIDTH, file=open(os.devnull, "w", encoding="utf-8"))  # noqa: PTH123, SIM115
    lines = done.stdout.rstrip().splitlines()
    console.print(Text(f"$ {asked.title or ' '.join(asked.command)}", style="bold"))
    console.print(Text.from_ansi("\n".join(lines[: asked.lines])))
    if len(lines) > asked.lines:
        console.print(Text(f"... {len(lines) - asked.lines} more lines", style="dim"))
    template = FONT_FACE.sub("", CONSOLE_SVG_FORMAT).replace("font-family: Fira Code", "font-family: Menlo, Consolas")
    svg = console.export_svg(title="dancetutor", code_format=template, unique_id="terminal")
    asked.out.write_text(svg, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()

"""Write the tables of docs that commands measure: `python tools/doc_figures.py [NAME...]`, all if none is named.

A table stands between `<!-- figures: NAME -->` and `<!-- end of figures -->`. The name of a page (physics, motion.md)
means all of its tables; --list prints the names. A table whose data are not here stays as it is, and a line says so.
"""

from __future__ import annotations

import os
import re
import sys
import traceback
from pathlib import Path

sys.path.extend(str(Path(__file__).resolve().parents[1] / name) for name in ("tools", "research"))

import cost_tables
import figures_feet
import figures_forms
import figures_lint
import figures_meter
import figures_motion
import figures_physics
import figures_retarget
import figures_speed
from figures_base import ROOT, Figures, MissingError

DOCS = ROOT / "docs"
FIGURES: Figures = {
    "costs": ("cost-model.md", cost_tables.tables),
    **figures_feet.FIGURES,
    **figures_forms.FIGURES,
    **figures_lint.FIGURES,
    **figures_meter.FIGURES,
    **figures_motion.FIGURES,
    **figures_physics.FIGURES,
    **figures_retarget.FIGURES,
    **figures_speed.FIGURES,
}
END = "<!-- end of figures -->"


def between(text: str, name: str) -> str:
    """The text of a page under this name."""
    found = re.search(rf"<!-- figures: {name} -->\n(.*?){END}", text, re.S)
    assert found, f"no figures '{name}' there"
    return found[1]


def named(words: list[str]) -> list[str]:
    """The blocks that the words of the command line mean. Raises SystemExit for a word that is none."""
    out: list[str] = []
    for word in words:
        found = [name for name, (page, _) in FIGURES.items() if word in (name, page, page.removesuffix(".md"))]
        if not found:
            sys.exit(f"no figures '{word}'; there are: {', '.join(FIGURES)}")
        out += found
    return list(dict.fromkeys(out))


def main() -> None:
    """Write those that are named, or all."""
    if sys.argv[1:] == ["--list"]:
        print("\n".join(f"{name:20} docs/{page}" for name, (page, _) in FIGURES.items()))
        return
    failed: list[str] = []
    for name in named(sys.argv[1:]) or FIGURES:
        page, make = FIGURES[name]
        path, before = DOCS / page, sum(os.times()[:4])
        try:
            made = make()
        except MissingError as missing:
            print(f"docs/{page}: {name} stays as it is: {missing} is not here", flush=True)
            continue
        except Exception:  # the others are measured all the same
            traceback.print_exc()
            failed.append(name)
            continue
        text = path.read_text("utf-8")
        begin = f"<!-- figures: {name} -->\n"
        path.write_text(text.replace(begin + between(text, name) + END, begin + made + END), encoding="utf-8")
        print(f"docs/{page}: {name}, {sum(os.times()[:4]) - before:.0f} s of processor time", flush=True)
    if failed:
        sys.exit(f"not measured: {', '.join(failed)}")


if __name__ == "__main__":
    main()

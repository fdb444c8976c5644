"""The tables of docs/cost-model.md from the presets itg and pump; tools/doc_figures.py writes them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).resolve().parent.parent
TIMES = (80, 150, 270, 500, 1000)


def tables() -> str:
    """Both tables: weights, and curves at some of their knots."""
    itg, pump = _preset("itg"), _preset("pump")
    said = _comments(ROOT / "configs" / "presets" / "itg.yaml")
    lines = ["| weight | `itg` | `pump` | what |", "| --- | ---: | ---: | --- |"]
    lines += [f"| `{k}` | {v} | {pump['weights'][k]} | {said[k]} |" for k, v in itg["weights"].items()]
    lines += ["", "Curves, `itg` / `pump`, by the time since the last row with steps:", ""]
    lines += [
        "| curve | " + " | ".join(f"{t} ms" for t in TIMES) + " | what |",
        "| --- |" + " ---: |" * len(TIMES) + " --- |",
    ]
    for name, curve in itg["curves"].items():
        costs = " | ".join(f"{curve[t]} / {pump['curves'][name][t]}" for t in TIMES)
        lines.append(f"| `{name}` | {costs} | {said[name]} |")
    return "\n".join(lines) + "\n"


def _preset(name: str) -> dict[str, Any]:
    found = yaml.safe_load((ROOT / "configs" / "presets" / f"{name}.yaml").read_text("utf-8"))
    assert isinstance(found, dict)
    return found


def _comments(path: Path) -> dict[str, str]:
    """The sentence of each key: behind it, or in the line above it."""
    found, above = {}, ""
    for line in path.read_text("utf-8").splitlines():
        if comment := re.match(r"  # (.*)", line):
            above = comment[1]
        elif key := re.match(r"  ([a-z0-9-]+): .*?(?:  # (.*))?$", line):
            found[key[1]] = key[2] or above
    return found

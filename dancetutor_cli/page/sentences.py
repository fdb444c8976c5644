"""What the feet do in a passage, in a sentence of each of the page's languages."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from dancetutor_cli.page.document import languages

if TYPE_CHECKING:
    from dancetutor_cli.lint.passages import Passage

_TURNED = 90.0  # degrees that are worth telling


def sentence(passage: Passage, labels: Mapping[str, str]) -> str:
    """One sentence, the most telling first."""
    left, right = passage.crossovers
    parts = [_filled(labels, "stream", passage.stream) if passage.stream else _filled(labels, "fast", passage.steps)]
    for name, count in (
        ("spin", passage.spins),
        ("crossover-left", left),
        ("crossover-right", right),
        ("bracket", passage.brackets),
        ("footswitch", passage.footswitches),
        ("doublestep", passage.doublesteps),
        ("jump", passage.jumps),
        ("hand", passage.hands),
        ("jack", passage.jacks),
    ):
        if count:
            times = labels["once"] if count == 1 else labels["times"].replace("{count}", str(count))
            parts.append(labels[f"sentence-{name}"].replace("{times}", times))
    if passage.turn >= _TURNED and not passage.spins:
        parts.append(labels["sentence-turn"].replace("{degrees}", f"{passage.turn:.0f}"))
    if passage.unsure:
        rows = labels["oneRow"] if passage.unsure == 1 else labels["rows"].replace("{count}", str(passage.unsure))
        parts.append(labels["sentence-close"].replace("{rows}", rows))
    text = ", ".join(parts) + "."
    return text[0].upper() + text[1:]


def told(passage: Passage) -> dict[str, Any]:
    """A passage as the page has it."""
    return {
        "from": passage.first,
        "to": passage.last,
        "start": round(passage.start, 6),
        "end": round(passage.end, 6),
        "rate": round(passage.rate, 2),
        "sentence": {name: sentence(passage, {**languages()["en"], **labels}) for name, labels in languages().items()},
    }


def _filled(labels: Mapping[str, str], name: str, count: int) -> str:
    return labels[f"sentence-{name}"].replace("{count}", str(count))

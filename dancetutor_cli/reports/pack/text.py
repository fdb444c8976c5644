"""A pack in a few lines of text, at the end of a run over many songs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from dancetutor_cli.reports.pack.facts import TECHNIQUES, Pack, PackChart
from dancetutor_cli.reports.safe import safe_path

LINES = 18  # at most
_TYPES, _OUTLIERS, _MISSING = 2, 4, 5
_LAST = 20  # it and all meters above stand together, below a +


def pack_lines(pack: Pack, width: int) -> list[str]:
    """The page: at most `LINES` lines, none wider than `width`."""
    charts = pack.charts()
    if not charts:
        return []
    lines = [f"pack {safe_path(pack.folder.rsplit('/', 1)[-1])}: {pack.songs} songs, {len(charts)} charts"]
    types = Counter(one.result.steps_type for one in charts)
    for steps_type, _ in types.most_common(_TYPES):
        lines += _by_meter(steps_type, [one for one in charts if one.result.steps_type == steps_type])
    lines.append(_by_technique(charts))
    lines += _listed("stands out", pack.outliers(), _OUTLIERS)
    lines += _listed("missing", pack.missing(), _MISSING)
    return [line if len(line) <= width else line[: width - 1] + "…" for line in lines[:LINES]]


def _by_meter(steps_type: str, charts: list[PackChart]) -> Iterator[str]:
    """Three rows: meters, charts labelled so, charts that play so."""
    labels = Counter(min(one.result.meter, _LAST) for one in charts)
    plays = Counter(min(round(one.result.estimate.meter), _LAST) for one in charts if one.result.estimate)
    shown = range(min([*labels, *plays]), max([*labels, *plays]) + 1)
    heads = {meter: "+" if meter == _LAST else str(meter) for meter in shown}
    wide = 1 + max(len(str(one)) for one in (*labels.values(), *plays.values(), *heads.values()))
    yield f"  {steps_type:14}" + "".join(f"{heads[meter]:>{wide}}" for meter in shown)
    yield f"  {'  labelled':14}" + "".join(f"{labels[meter] or '·':>{wide}}" for meter in shown)
    if plays:
        yield f"  {'  plays like':14}" + "".join(f"{plays[meter] or '·':>{wide}}" for meter in shown)


def _by_technique(charts: list[PackChart]) -> str:
    """How many charts have each technique."""
    told = [f"{technique} {sum(one.rows_of(technique) > 0 for one in charts)}" for technique in TECHNIQUES]
    return f"  charts with {', '.join(told)}"


def _listed(what: str, said: Iterable[str], most: int) -> Iterator[str]:
    lines = list(said)
    for line in lines[:most]:
        yield f"  {what}: {line}"
    if len(lines) > most:
        yield f"  {what}: {len(lines) - most} more; --report-html FILE shows them"

"""A `FileResult` as bytes and back: JSON behind a checksum, so that a damaged or foreign file is no result.

Nothing of what is read can run: of JSON come numbers and texts, and what is made of them are this module's own classes.
Values stand in lists, in the order of the fields, for there are thousands of findings in a pack.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from dataclasses import fields
from operator import attrgetter
from typing import Any

from dancetutor_cli.jobs.result import ChartResult, FileResult
from dancetutor_cli.lint.chart_figures import AlternativeResult, Cause, DifferentRun, Figures
from dancetutor_cli.lint.finding import ExcerptRow, Finding
from dancetutor_cli.meter.bill import Estimate

_HEAD = b"dancetutor result 2\n"  # another number whenever the form below changes
_DIGEST = 32  # bytes of SHA-256
_CLASSES = (FileResult, ChartResult, Finding, Figures, AlternativeResult, DifferentRun, Cause, Estimate)
_VALUES = {kind: attrgetter(*(field.name for field in fields(kind))) for kind in _CLASSES}
_CHART_FIELDS = tuple(field.name for field in fields(ChartResult))
_EXCERPT = [field.name for field in fields(Finding)].index("excerpt")


def to_bytes(result: FileResult, key: str) -> bytes:
    """The content of the file of a result; `key` tells what the result depends on, and belongs to it."""
    text = json.dumps(result, default=lambda one: _VALUES[type(one)](one), separators=(",", ":"))
    data = text.encode("ascii")
    return _HEAD + _digest(data, key) + data


def from_bytes(content: bytes, key: str) -> FileResult | None:
    """The result in a file's content; None unless it is just what `to_bytes` gave for this key."""
    data = content[len(_HEAD) + _DIGEST :]
    if content[: len(_HEAD)] != _HEAD or content[len(_HEAD) : len(_HEAD) + _DIGEST] != _digest(data, key):
        return None
    try:
        return _file(json.loads(data))
    except (ValueError, TypeError, KeyError, IndexError, RecursionError):
        return None  # somebody else's work, whose checksum is right


def _digest(data: bytes, key: str) -> bytes:
    return hashlib.sha256(key.encode() + b"\0" + data).digest()


def _file(values: list[Any]) -> FileResult:
    path, title, artist, error, warnings, findings, charts, unselected = values
    return FileResult(
        path, title, artist, error, tuple(warnings), _findings(findings), tuple(map(_chart, charts)), tuple(unselected)
    )


def _findings(listed: Iterable[list[Any]]) -> tuple[Finding, ...]:
    for values in listed:
        values[_EXCERPT] = tuple(ExcerptRow(*row) for row in values[_EXCERPT])
    return tuple(Finding(*values) for values in listed)


def _chart(values: list[Any]) -> ChartResult:
    given = dict(zip(_CHART_FIELDS, values, strict=True))
    given["findings"] = _findings(given["findings"])
    if given["figures"] is not None:
        mean, peak, breakdown, stream, tech, seconds, facing = given["figures"]
        given["figures"] = Figures(mean, peak, breakdown, stream, tech, seconds, tuple(facing))
    if given["alternatives"] is not None:
        given["alternatives"] = tuple(map(_alternative, given["alternatives"]))
    if given["causes"] is not None:
        given["causes"] = tuple(Cause(*cause) for cause in given["causes"])
    if given["ambiguous"] is not None:
        given["ambiguous"] = tuple(map(tuple, given["ambiguous"]))
    if given["estimate"] is not None:
        meter, low, high, scale, known, terms, rate = given["estimate"]
        given["estimate"] = Estimate(meter, low, high, scale, known, tuple(map(tuple, terms)), rate)
    return ChartResult(**given)


def _alternative(values: list[Any]) -> AlternativeResult:
    extra, terms, runs = values
    return AlternativeResult(extra, tuple(map(tuple, terms)), tuple(DifferentRun(*run) for run in runs))

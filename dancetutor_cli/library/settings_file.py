"""dancetutor.yaml: where it is looked for, which charts an entry of it is about, and what is wrong in it."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from dancetutor_cli.bounded import leads_out, shown_key
from dancetutor_cli.chart import names
from dancetutor_cli.errors import FileError, did_you_mean

FILE_NAME = "dancetutor.yaml"
_WHEN_KEYS = ("path", "steps-type", "difficulty", "meter")


class SettingError(Exception):
    """Something wrong at a key path inside a file."""

    def __init__(self, keys: Sequence[str | int], message: str) -> None:
        super().__init__(message)
        self.keys = tuple(keys)
        self.message = message


def find_settings_file(start: Path) -> Path | None:
    """The nearest dancetutor.yaml in the folder of `start` or above it; whoever reads it says so if it is no file."""
    return next((Path(place) for place in _places(start) if os.path.exists(place)), None)  # noqa: PTH110 (quicker)


def check_not_a_link_out(path: Path) -> None:
    """Raise FileError if a dancetutor.yaml that lay there is a link that leads out of its folder: what is said of its
    mistakes would tell of a file that is none of its author's business."""
    if path.is_symlink() and leads_out(path, path.parent):
        raise FileError(path, "is a link that leads out of its folder; put a copy there, or name it with --config")


def places_of_settings_file(start: Path) -> Iterator[Path]:
    """Where a dancetutor.yaml for the charts of the folder `start` may be, nearest first."""
    return map(Path, _places(start))


def _places(start: Path) -> Iterator[str]:
    folder, below = os.path.abspath(start), ""  # noqa: PTH100 (links stay links)
    while folder != below:
        yield os.path.join(folder, FILE_NAME)  # noqa: PTH118
        folder, below = os.path.dirname(folder), folder  # noqa: PTH120


@dataclass(frozen=True, slots=True)
class Condition:
    """When a layer holds; an empty part always does.

    paths : shell patterns, relative to the folder of the configuration `root`
    steps_types : shell patterns in lower case; difficulties : names of today in lower case
    meters : least and greatest meter
    """

    root: str = ""
    paths: tuple[str, ...] = ()
    steps_types: tuple[str, ...] = ()
    difficulties: tuple[str, ...] = ()
    meters: tuple[int, int] | None = None

    @property
    def is_about_charts(self) -> bool:
        """Whether it can only be decided for a chart."""
        return bool(self.steps_types or self.difficulties or self.meters)

    def holds_for_path(self, path: Path) -> bool:
        """Whether one of the patterns fits; a pattern without a slash fits any part of the path, as in .gitignore."""
        if not self.paths:
            return True
        path = path.absolute()
        if path.is_relative_to(self.root):
            path = path.relative_to(self.root)
        whole = path.as_posix()
        return any(
            fnmatchcase(whole, pattern) if "/" in pattern else any(fnmatchcase(part, pattern) for part in path.parts)
            for pattern in self.paths
        )

    def holds_for_chart(self, steps_type: str, difficulty: str, meter: int) -> bool:
        """Whether steps type, difficulty and meter fit."""
        return (
            (not self.steps_types or any(fnmatchcase(steps_type.lower(), pattern) for pattern in self.steps_types))
            and (not self.difficulties or difficulty.lower() in self.difficulties)
            and (self.meters is None or self.meters[0] <= meter <= self.meters[1])
        )


def condition_of(when: Any, folder: Path, place: tuple[str | int, ...]) -> Condition:
    """What `when` of an entry says; SettingError at its key if that is nothing. folder : of the file"""
    if not isinstance(when, Mapping) or not when:
        raise SettingError(place, f"this needs 'when' with one or more of {', '.join(_WHEN_KEYS)}")
    check_keys(when, _WHEN_KEYS, place)
    return Condition(
        root=str(folder.absolute()),
        paths=tuple(texts_of(when, "path")),
        steps_types=tuple(_steps_type(text, (*place, "steps-type")) for text in texts_of(when, "steps-type")),
        difficulties=tuple(_difficulty(text, (*place, "difficulty")) for text in texts_of(when, "difficulty")),
        meters=_meters(when["meter"], (*place, "meter")) if "meter" in when else None,
    )


def _steps_type(text: str, place: tuple[str | int, ...]) -> str:
    """A steps type or a shell pattern of such, that fits one at least."""
    pattern = names.steps_type(text)
    if not any(fnmatchcase(known, pattern) for known in names.COLUMNS):
        near = did_you_mean(pattern, names.COLUMNS)
        there = ", ".join(sorted({f"{known.partition('-')[0]}-*" for known in names.COLUMNS}))
        raise SettingError(place, f"'{shown_key(text)}' is no steps type{near}; there are {there}")
    return pattern


def _difficulty(text: str, place: tuple[str | int, ...]) -> str:
    """A difficulty under today's name; old ones ("Heavy", "Oni") are known as everywhere."""
    name, known = names.difficulty(text, "", 0, old=True)
    if not known:
        near, there = did_you_mean(text, names.DIFFICULTIES), ", ".join(names.DIFFICULTIES)
        raise SettingError(place, f"'{shown_key(text)}' is no difficulty{near}; there are {there}")
    return name.lower()


def _meters(value: Any, place: tuple[str | int, ...]) -> tuple[int, int]:
    """A meter, or a range written "1-7", "8-" or "-7"."""
    low, dash, high = str(value).partition("-")
    try:
        return int(low or 0), int(high or 1_000_000) if dash else int(low)
    except ValueError:
        raise SettingError(place, f'"{value}" is no range of meters; write 8, "1-7", "8-" or "-7"') from None


def texts_of(data: Mapping[str, Any], key: str) -> list[str]:
    """A value that may be one text or a list of them; empty where there is none."""
    value = data.get(key)
    if value is None:
        return []
    return [str(entry) for entry in value] if isinstance(value, list) else [str(value)]


def check_keys(data: Mapping[str, Any], known: Sequence[str], place: tuple[str | int, ...]) -> None:
    """Raise unless every key is one of `known`; the error names them."""
    for key in data:
        if key not in known:
            raise SettingError((*place, str(key)), f"there is no '{shown_key(key)}' here; there are {', '.join(known)}")

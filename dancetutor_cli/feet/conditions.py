"""Which charts an entry of dancetutor.yaml is about, and mistakes in that."""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated, Any, ClassVar

from dancetutor_cli.chart import names
from dancetutor_cli.run.errors import did_you_mean
from dancetutor_cli.run.reading import shown_key
from dancetutor_cli.run.schema import SEVERAL, Entries, Parsed, Texts


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


def _steps_type(text: Any) -> str:
    """A steps type or a shell pattern of such, that fits one at least."""
    pattern = names.steps_type(str(text))
    if not any(fnmatchcase(known, pattern) for known in names.COLUMNS):
        near = did_you_mean(pattern, names.COLUMNS)
        there = ", ".join(sorted({f"{known.partition('-')[0]}-*" for known in names.COLUMNS}))
        raise ValueError(f"'{shown_key(text)}' is not a steps type{near}; choose {there}")
    return pattern


def _difficulty(text: Any) -> str:
    """A difficulty under today's name; old ones ("Heavy", "Oni") are known as everywhere."""
    name, known = names.difficulty(str(text), "", 0, old=True)
    if not known:
        near, there = did_you_mean(str(text), names.DIFFICULTIES), ", ".join(names.DIFFICULTIES)
        raise ValueError(f"'{shown_key(text)}' is not a difficulty{near}; choose {there}")
    return name.lower()


def _meters(value: Any) -> tuple[int, int]:
    """A meter, or a range written "1-7", "8-" or "-7"."""
    low, dash, high = str(value).partition("-")
    try:
        return int(low or 0), int(high or 1_000_000) if dash else int(low)
    except ValueError:
        raise ValueError(f'"{shown_key(value)}" is not a range of meters; write 8, "1-7", "8-" or "-7"') from None


@dataclass(eq=False, repr=False)
class _WhenKeys:
    """What `when` of an entry may say; each one value or a list, as in `Condition`."""

    HYPHENS: ClassVar[bool] = True
    path: Texts = ()
    steps_type: Annotated[tuple[Annotated[str, Parsed(_steps_type)], ...], SEVERAL] = ()
    difficulty: Annotated[tuple[Annotated[str, Parsed(_difficulty)], ...], SEVERAL] = ()
    meter: Annotated[tuple[int, int], Parsed(_meters, "a meter or a range of them")] | None = None


When = Annotated[_WhenKeys, Entries(1)]


def condition_of(when: When, folder: Path) -> Condition:
    """When an entry holds. folder : of the file, which its paths are relative to"""
    return Condition(str(folder.absolute()), when.path, when.steps_type, when.difficulty, when.meter)

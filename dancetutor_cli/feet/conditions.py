"""The `when` conditions of dancetutor.yaml, which select the charts that an entry applies to."""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated, Any, ClassVar

from dancetutor_cli.chart import names
from dancetutor_cli.run.errors import choose_text, did_you_mean
from dancetutor_cli.run.reading import shown_key
from dancetutor_cli.run.schema import SEVERAL, Entries, Parsed, Texts


@dataclass(frozen=True, slots=True)
class Condition:
    """The condition under which an entry applies; an empty field matches everything.

    paths : shell patterns, relative to the folder of the configuration `root`
    steps_types : shell patterns in lower case; difficulties : current names in lower case
    meters : least and greatest meter
    """

    root: str = ""
    paths: tuple[str, ...] = ()
    steps_types: tuple[str, ...] = ()
    difficulties: tuple[str, ...] = ()
    meters: tuple[int, int] | None = None

    def holds_for_file(self, path: Path) -> bool:
        """Whether the condition is about paths alone and matches this one."""
        return not (self.steps_types or self.difficulties or self.meters) and self._matches(path)

    def holds(self, path: Path, steps_type: str, difficulty: str, meter: int) -> bool:
        """Whether the path, the steps type, the difficulty and the meter of a chart match."""
        return (
            (not self.steps_types or any(fnmatchcase(steps_type.lower(), pattern) for pattern in self.steps_types))
            and (not self.difficulties or difficulty.lower() in self.difficulties)
            and (self.meters is None or self.meters[0] <= meter <= self.meters[1])
            and self._matches(path)
        )

    def _matches(self, path: Path) -> bool:
        """Whether a pattern matches the path; as in .gitignore, a pattern without a slash matches any part of it."""
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


def _steps_type(text: Any) -> str:
    """Return a steps type, or a shell pattern that matches at least one known steps type; else raise ValueError."""
    pattern = names.steps_type(str(text))
    if not any(fnmatchcase(known, pattern) for known in names.COLUMNS):
        near = did_you_mean(pattern, names.COLUMNS)
        there = ", ".join(sorted({f"{known.partition('-')[0]}-*" for known in names.COLUMNS}))
        raise ValueError(f"'{shown_key(text)}' is not a steps type{near}; choose {there}")
    return pattern


def _difficulty(text: Any) -> str:
    """Return the current name of a difficulty, in lower case; old names such as "Heavy" and "Oni" are accepted."""
    name, known = names.difficulty(str(text), "", 0, old=True)
    if not known:
        raise ValueError(f"'{shown_key(text)}' is not a difficulty{choose_text(str(text), names.DIFFICULTIES)}")
    return name.lower()


def _meters(value: Any) -> tuple[int, int]:
    """Parse a meter, or a range of meters written "1-7", "8-" or "-7"."""
    low, dash, high = str(value).partition("-")
    try:
        return int(low or 0), int(high or 1_000_000) if dash else int(low)
    except ValueError:
        raise ValueError(f'"{shown_key(value)}" is not a range of meters; write 8, "1-7", "8-" or "-7"') from None


@dataclass(eq=False, repr=False)
class _WhenKeys:
    """The keys of `when` in an entry, as in `Condition`; every key except `meter` also takes a list."""

    HYPHENS: ClassVar[bool] = True
    path: Texts = ()
    steps_type: Annotated[tuple[Annotated[str, Parsed(_steps_type)], ...], SEVERAL] = ()
    difficulty: Annotated[tuple[Annotated[str, Parsed(_difficulty)], ...], SEVERAL] = ()
    meter: Annotated[tuple[int, int], Parsed(_meters, "a meter or a range of them")] | None = None


When = Annotated[_WhenKeys, Entries(1)]


def condition_of(when: When, folder: Path) -> Condition:
    """Return the condition of an entry. folder : folder of the file, to which the paths of the entry are relative"""
    return Condition(str(folder.absolute()), when.path, when.steps_type, when.difficulty, when.meter)

"""What the linter is asked to do: severities and options of every rule, from configs/lint/ and dancetutor.yaml."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from dancetutor_cli.errors import FileError
from dancetutor_cli.resources import config_path

SEVERITIES = ("error", "warning", "info", "off")
_Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


@dataclass(frozen=True, slots=True)
class Settings:
    """Severity and options of every rule: code -> {"severity": ..., option: ...}. Plain data, so that it pickles."""

    rules: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    def active(self) -> dict[str, Mapping[str, Any]]:
        """The rules that are not off."""
        return {code: options for code, options in self.rules.items() if options["severity"] != "off"}


def default_settings() -> Settings:
    """The settings of configs/lint/default.yaml."""
    path = config_path("lint/default.yaml")
    data = read_yaml(path)
    return Settings(rules=data["rules"])


def read_yaml(path: Path) -> dict[str, Any]:
    """A YAML file whose top is a mapping; FileError with its line otherwise."""
    try:
        data = yaml.load(path.read_bytes(), Loader=_Loader)
    except OSError as error:
        raise FileError(path, error.strerror or str(error)) from error
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = None if mark is None else mark.line + 1
        raise FileError(path, f"is not YAML: {getattr(error, 'problem', error)}", line) from error
    if not isinstance(data, dict):
        raise FileError(path, "must be a mapping of names to values")
    return data

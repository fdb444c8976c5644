"""Bytes of a chart file -> Song and Chart: positions, rows, timing.

Names are looked up when they are used, so that what games call things (`names`) is known without numpy.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Kind, Song
    from dancetutor_cli.chart.reader import load, parse

__all__ = ["Chart", "Kind", "Song", "load", "parse"]
_MODULES = {"model": ("Chart", "Kind", "Song"), "reader": ("load", "parse")}


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{module}"), name)
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")

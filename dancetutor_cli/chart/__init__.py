"""Bytes of a chart file -> Song and Chart: positions, rows, timing."""

from dancetutor_cli.chart.model import Chart, Kind, Song
from dancetutor_cli.chart.reader import load, parse

__all__ = ["Chart", "Kind", "Song", "load", "parse"]

"""The page for who puts a pack together: charts by meter and technique, outliers, what is missing; text and HTML."""

from __future__ import annotations

from dancetutor_cli.reports.pack.facts import Pack
from dancetutor_cli.reports.pack.html import html_page
from dancetutor_cli.reports.pack.text import pack_lines

__all__ = ["Pack", "html_page", "pack_lines"]

"""The chart sheet: a chart as columns of measures, like a musical score, on paper or on a page."""

from dancetutor_cli.reports.sheet.whole import html_page, make_sheet, svg_sheet

__all__ = ["html_page", "make_sheet", "svg_sheet"]

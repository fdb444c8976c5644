"""The practice page: one HTML file in which the dancer plays a chart and waits for whoever learns it."""

from dancetutor_cli.page.content import Content, pack_content
from dancetutor_cli.page.document import document

__all__ = ["Content", "document", "pack_content"]

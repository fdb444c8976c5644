"""The index of a folder of practice pages: plain links, grouped by song; no script."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from urllib.parse import quote

from dancetutor_cli.page.document import HERE, listed


@dataclass(frozen=True, slots=True)
class IndexEntry:
    """One page. file : its name in the folder; title, artist : of the song; label : of the chart"""

    file: str
    title: str
    artist: str
    label: str


def index_page(entries: Sequence[IndexEntry], title: str) -> bytes:
    """The page that leads to the others; songs in the order given, names never as markup."""
    style = (HERE / "index.css").read_text("utf-8")
    songs = []
    for (name, artist), group in groupby(entries, key=lambda one: (one.title, one.artist)):
        by = f" <small>{html.escape(artist)}</small>" if artist else ""
        links = "".join(f'<li><a href="{quote(one.file)}">{html.escape(one.label)}</a></li>' for one in group)
        songs.append(f"<h2>{html.escape(name)}{by}</h2>\n<ul>{links}</ul>")
    return listed(title, "\n".join(songs), style)

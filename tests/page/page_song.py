"""A small song for the tests of the practice page."""

from __future__ import annotations

from pathlib import Path

# Hostile on purpose: all that people write is text. A measure of rest, then steps, a crossover, a jump and a hold, and
# a quiet end: the beginning is the hardest passage, and the linter finds a note that never counts.
TITLE = "</script><script>window.hacked=1</script>\"'><img src=x onerror=window.hacked=1>{{data}}&amp;"
SONG = (
    "#VERSION:0.83;\n#TITLE:{title};\n#ARTIST:<b>{title}</b>;\n#MUSIC:x.wav;\n#OFFSET:0;\n#BPMS:0=120;\n#FAKES:36=2;\n"
    "#NOTEDATA:;\n#STEPSTYPE:dance-single;\n#DIFFICULTY:Hard;\n#METER:9;\n#CREDIT:<script>window.hacked=1</script>;\n"
    "#NOTES:\n0000\n0000\n0000\n0000\n,\n1000\n0100\n0001\n0100\n1000\n0001\n0010\n0001\n"
    ",\n1001\n0000\n0200\n0000\n0000\n0300\n1000\n000M\n"
    + 3 * ",\n1000\n0000\n0000\n0000\n,\n0001\n0000\n0000\n0000\n"
    + ",\n1000\n0000\n0000\n0000\n;\n"
)


def write_song(folder: Path, title: str = TITLE) -> Path:
    """A song's file with that title."""
    path = folder / "song.ssc"
    path.write_text(SONG.replace("{title}", title.replace(";", "\\;").replace(":", "\\:")), "utf-8")
    return path

"""What a path means: folders and packs, pairs of .sm and .ssc, selection of charts, the song's music."""

from dancetutor_cli.library.files import find_files, twin
from dancetutor_cli.library.music import music_file
from dancetutor_cli.library.selection import select, select_one

__all__ = ["find_files", "music_file", "select", "select_one", "twin"]

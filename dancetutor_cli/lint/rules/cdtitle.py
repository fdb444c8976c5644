"""DT511: the CDTITLE is missing or has an odd size."""

from __future__ import annotations

from dancetutor_cli.lint.pictures import PictureRule


class CdTitle(PictureRule):
    """#CDTITLE is empty, names a file that is not there or is empty, or a picture of an unusual size.

    `required`: whether a song without the tag is reported. `proportions`: of width and height that are accepted.
    `sizes`: the sizes that are accepted; an empty list accepts every size.

    Bad: #CDTITLE:nowhere.png; Better: a picture beside the song, or in the pack's folder: ../pack.png.
    """

    code = "DT511"
    name = "cdtitle"
    tag = "CDTITLE"

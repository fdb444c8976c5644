"""DT505: the background is missing or has an odd size."""

from __future__ import annotations

from dancetutor_cli.lint.pictures import PictureRule


class BackgroundSize(PictureRule):
    """#BACKGROUND is empty, names a file that is not there or empty, or a picture of an unusual size.

    `required`: whether a song without the tag is reported. `sizes`: the sizes that are accepted, as "1920x1080";
    `proportions`: sizes with an accepted proportion. Of an empty list every one is accepted. Films have no size here.

    Bad: #BACKGROUND:nowhere.png; Better: a picture of 1920x1080 beside the song.
    """

    code = "DT505"
    name = "background-size"
    tag = "BACKGROUND"

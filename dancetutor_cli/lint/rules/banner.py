"""DT504: the banner is missing or has an odd size."""

from __future__ import annotations

from dancetutor_cli.lint.pictures import PictureRule


class BannerSize(PictureRule):
    """#BANNER is empty, names a file that is not there or empty, or a picture of an unusual size.

    `required`: whether a song without the tag is reported. `sizes`: the sizes that are accepted, as "418x164";
    `proportions`: sizes with an accepted proportion. Of an empty list every one is accepted. Films have no size here.

    Bad: #BANNER:nowhere.png; Better: a picture of 418x164 beside the song.
    """

    code = "DT504"
    name = "banner-size"
    tag = "BANNER"

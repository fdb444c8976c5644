"""DT504: the banner is missing or has an odd size."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.pictures import picture_fault, sizes_fault
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class BannerSize(FileRule):
    """#BANNER is empty, names a file that is not there, or a picture of an unusual size.

    `required`: whether a song without the tag is reported. `sizes`: the sizes that are accepted, as "418x164"; an empty
    list accepts every size.

    Bad: #BANNER:nowhere.png; Better: a picture of 418x164 beside the song.
    """

    code = "DT504"
    name = "banner-size"

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """Sizes that are none."""
        return sizes_fault(value) if option == "sizes" else None

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        fault = picture_fault(subject.song, "BANNER", self.options["sizes"], required=self.options["required"])
        if fault:
            yield self.finding(fault, subject.tag_place("BANNER"))

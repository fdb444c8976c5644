"""What is large and not needed by everybody is an extra: which packages that is, and what to say without them.

A message names the packages themselves: `pip install NAME` works in whatever way dancetutor itself was installed, and
fetches no stranger's package that happens to be called dancetutor.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

Extra = Literal["physics", "gl", "ffmpeg", "cluster"]
PACKAGES: Mapping[Extra, str] = {
    "physics": "mujoco-core",
    "gl": "pyrender==0.1.45",
    "ffmpeg": "imageio-ffmpeg",
    "cluster": "distributed",
}


def how_to_add(extra: Extra) -> str:
    """The command that adds an extra, for the end of a message."""
    return f"pip install {PACKAGES[extra]}"

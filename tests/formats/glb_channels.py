"""The animation in a .glb file, as a viewer reads it; for the tests of .glb files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from dancetutor_cli.character.container import read_container

Channels = dict[tuple[str, str], tuple[np.ndarray, np.ndarray]]


def channels_of(path: Path) -> Channels:
    """Times and values of each channel, by node name and path."""
    container = read_container(path)
    animation = container.document["animations"][0]
    out: Channels = {}
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        name = container.document["nodes"][channel["target"]["node"]]["name"]
        times, values = (container.accessor(sampler[k]) for k in ("input", "output"))
        out[name, channel["target"]["path"]] = times, values
    return out

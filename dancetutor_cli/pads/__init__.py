"""Panel geometry of each steps type, from `configs/pads.yaml`."""

from dancetutor_cli.pads.pad import Pad, Panel, load_pad, pad_names

__all__ = ["Pad", "Panel", "load_pad", "pad_names"]

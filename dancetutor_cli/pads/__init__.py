"""Panel geometry of each steps type, from configs/pads.yaml."""

from dancetutor_cli.pads.pad import MAX_PANELS, Pad, load_pad, load_pads

__all__ = ["MAX_PANELS", "Pad", "load_pad", "load_pads"]

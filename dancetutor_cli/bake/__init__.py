"""Baking: a play in, a motion out, and what its quality is."""

from dancetutor_cli.bake.bake import bake, bake_plan

__all__ = ["bake", "bake_plan"]

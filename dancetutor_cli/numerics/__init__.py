"""Banded systems, quadratic programmes, smoothing and filters over time: no dancer in them."""

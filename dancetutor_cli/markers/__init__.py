"""Feet written into chart files and beside them, and taken out again."""

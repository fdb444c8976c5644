"""Find the feet of a stepchart, lint it, annotate it, bake and render a dancer who plays it."""

__version__ = "0.1.0"

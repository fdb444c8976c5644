"""Find the feet of a stepchart, lint it, annotate it, bake and render a dancer who plays it."""

__version__ = "0.2.0.dev0"

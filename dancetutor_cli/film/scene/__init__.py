"""What stands in space: stage, dancer, bar and screen, the camera that sees them; renderers in `cpu` and `gl`."""

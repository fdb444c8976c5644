"""Things that only follow the body: hair."""

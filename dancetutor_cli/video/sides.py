"""How small and how large a picture may be: the same for options, layouts and screens in the room."""

LEAST_SIDE = 64  # pixels
MOST_SIDE = 7680

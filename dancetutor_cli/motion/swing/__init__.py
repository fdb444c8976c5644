"""One foot in the air or on the ground: where it is at any time, on which way, past what."""

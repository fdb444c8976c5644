"""What is drawn flat on the picture: notes, pads from above, words; whole numbers on sRGB values."""

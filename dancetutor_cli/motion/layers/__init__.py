"""What comes on top of the solved body: gaze, breath, blinks, wrists."""

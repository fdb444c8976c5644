"""From a plan to the body over the feet: its path over the ground, its height, its turns, leans and bends."""

"""From a plan to the body over the feet: its way over the ground, its height, how it turns, leans and bends."""

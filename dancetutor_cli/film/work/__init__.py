"""The work of films: what is wanted, its plan, the segments that other processes draw, batches of films."""

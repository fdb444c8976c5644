"""What follows the body by mechanics: the ragdoll and its styles, pushes, captured motion, the braid."""

"""From the body's trajectory to joint rotations: targets of hands, feet and shoulders, and the solver of the chain."""

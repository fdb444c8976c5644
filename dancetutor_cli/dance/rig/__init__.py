"""The dancer's body in numbers: joints and limits, masses, soles, quaternions, the two-bone limb."""

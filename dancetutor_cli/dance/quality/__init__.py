"""What the program itself measures about a motion, by forward kinematics from its rotations."""

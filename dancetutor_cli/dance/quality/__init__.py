"""What the program itself measures about a motion, by forward kinematics from its rotations.

report                        the quality report: all figures of a motion, which the modules below measure
  |   figures                   what a report holds, and the motion on which it is measured
  |   contact, dynamics         limbs on their panels; forces, free fall and balance
  |   posture, liveliness       poses that are possible and look right; how much a body takes part in a dance
"""

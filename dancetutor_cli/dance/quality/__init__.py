"""The measurements of a motion, by forward kinematics from its rotations.

report                        the quality report: it collects the figures of the modules below
  |   figures                   the fields of a report, and the motion on which it is measured
  |   contact, dynamics         limbs on their panels; forces, free fall and balance
  |   posture, liveliness       poses that are possible and look right; how much each part of the body moves
"""

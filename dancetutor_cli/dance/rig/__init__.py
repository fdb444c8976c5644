"""The dancer's body in numbers: joints and limits, masses, soles, quaternions, the two-bone limb.

quaternion                    rotations: functions on arrays (..., 4)
skeleton                      joints, their hierarchy, rest positions and limits
body                          forward kinematics, masses, points that touch the pad
body                          forward kinematics, masses, the points that touch the pad
"""

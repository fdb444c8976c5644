"""The dancer's body in numbers: joints and limits, masses, soles, quaternions, the two-bone limb.

quaternion                    rotations: functions on arrays (..., 4)
skeleton                      joints, their hierarchy, rest positions and limits
body                          forward kinematics, masses, points that touch the pad
limbs                         the two-bone limb in closed form; capsules, and how deep one is in another
"""

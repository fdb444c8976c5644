"""The dancer's body in numbers: joints and limits, masses, soles, quaternions, arms and legs of two bones.

quaternion                    rotations: functions on arrays (..., 4)
skeleton                      joints, their hierarchy, rest positions and limits
body                          forward kinematics, masses, points that touch the pad
two_bones                     a leg or an arm: bends, and turns that reach a place
limbs                         the same for kernels; capsules, and how deep one is in another
"""

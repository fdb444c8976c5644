"""The dancer's body in numbers: joints and limits, masses, soles, quaternions, arms and legs of two bones.

quaternion                    rotations: functions on arrays (..., 4)
skeleton                      joints, their hierarchy, rest positions and limits
body                          forward kinematics, masses, points that touch the pad
limbs                         a leg or an arm: bends, and turns that reach a place; capsules, how deep they overlap
"""

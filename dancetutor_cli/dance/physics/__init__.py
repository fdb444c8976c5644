"""Mechanics that follow the body: the ragdoll and its styles, pushes, captured motion, the braid.

style, blend                  how a ragdoll follows the dancer; the share of each style at each second
ragdoll, simulation           capsules, boxes and springs of a body; the steps of the physics engine
pushes                        other forces: soles that hold and break loose, shoves, obstacles that catch a foot
pipeline                      `through_ragdoll`: passes a motion through all of these in order
  |   repin, plants, stands     feet where the input has them; soles that were held; feet that are seen to stand
  |   legs, arms                legs that do not pop, mass on its path, ankles in their limits; arms out of the trunk
tuning                        springs and densities for a new body
standing, captured            captured motion: the pose from which joints turn; that motion on the rig's joints
hair                          the braid, computed last, from the finished motion
"""

"""What follows the body by mechanics: the ragdoll and its styles, pushes, captured motion, the braid.

style, blend                  how a ragdoll follows the dancer; how much of which style there is when
ragdoll, simulation           capsules, boxes and springs of a body; the engine's steps
pushes                        what else acts: soles that hold and break, shoves, obstacles that catch a foot
pipeline                      `through_ragdoll`: all of it in order, for a motion
  |   repin, plants, stands     feet where the input has them; soles that were held; feet that people see stand
  |   legs, ankles, arms        legs that do not pop, mass on its path; ankles in their limits; arms out of the trunk
tuning                        springs and densities for a body not seen before
standing, captured            captured motion: the pose from which joints turn; that motion on the rig's joints
hair                          the braid, last and alone
"""

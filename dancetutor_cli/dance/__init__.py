"""How a play becomes a motion, in five stages. Each takes one type and returns one; all know the `Context`.

In this package "she" is the dancer, whatever character the user draws.

    feet.play.Play                  the feet that step each note, from the solver
      |   feet.unplayable             removes the notes that cannot be played
      |   footwork.planner            rules: step, jump, gallop, hold, bracket, mine, sidestep, walk, shake
    plan.Plan                       when each foot leaves and lands, where, how; turns; palms; walks; contacts
      |   foot_path.both_feet         where a foot is at any time
      |   trajectory.posture          computes balance, height, facing, reach, counter-rotation, beat bounce
    trajectory.posture.Trajectory   the path and posture of the body over the feet, at even times
      |   ik.targets.ik_targets       computes where pelvis, shoulders, hands and feet must be
    ik.full_body.Targets
      |   ik.full_body.solve_poses    solves all joints at once
    units.Poses                     local rotations and root
      |   layers                      adds gaze, glances, breath, blinks, wrists, hands
    motion.Motion                   the input of files, films and the quality report

No stage calls a later one. `settle` repeats trajectory and inverse kinematics until the two agree, and returns the
remaining differences (its residuals). `grips` places hands on the bar where `rail_reach` says that arms reach it. Hair
(`physics.hair`) comes last.

    units, context, settings      types; panels, bar and skeleton around the dancer; the numbers of
                                  `configs/motion.yaml`, a class for each section: settings_feet, settings_body,
                                  settings_arms
    changes                       numbers that change over a song
    clearance, gait               a foot's path in the air, for `foot_path`; how the body moves with the steps of a walk
    waits, face                   the dancer's movements while she waits; lids, smiles and eyes
    request, performance          the user's options; the dancers of a chart and their dance, also of two on one pad
    pieces, bake, keys            the pieces of a song, and their store; the order of work for a piece; the keys
    ends                          the beginning and the end of a cut
    smoothing                     paths over time
    quadratic                     banded least squares with limits

The mirror image of a play gives the mirror image of the motion: where both sides are equal, the leading foot decides
(`Plan.lead`). Numbers are in `configs/motion.yaml` (`settings`) and `configs/gaits` (`gait`), or follow from the rig.
"""

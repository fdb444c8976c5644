"""How a play becomes a motion: five stages, each takes one type and returns one. All of them know the `Context`.

In this package "she" is the dancer, whatever character is drawn.

    feet.play.Play                  who steps what, from the solver
      |   feet.play                   without the notes that no person plays
      |   footwork.planner            rules: step, jump, gallop, hold, bracket, mine, sidestep, walk, shake
    plan.Plan                       when each foot leaves and lands, where, how; turns; palms; walks; contacts
      |   foot_path.both_feet         where a foot is at any time
      |   trajectory.posture          balance, height, facing, reach, counter-rotation, beat bounce
    trajectory.posture.Trajectory   the body over the feet at even times
      |   ik.targets.ik_targets       where pelvis, shoulders, hands and feet must be
    ik.full_body.Targets
      |   ik.full_body.solve          all joints at once
    ik.full_body.Poses              local rotations and root
      |   layers                      gaze, glances, breath, blinks, wrists, hands
    motion.Motion                   what files, films and the quality report get

No stage calls a later one. `settle` repeats trajectory and inverse kinematics until both fit, and returns how well they
do (its residuals). `grips` places hands on the bar after a rough bake. Hair (`physics.hair`) comes last.

    units, context, settings      types; panels, bar and skeleton around the dancer; numbers of `configs/motion.yaml`,
                                  a class for each section: settings_feet, settings_body, settings_arms
    changes                       numbers that change over a song
    clearance, gait               a foot's path in the air, for `foot_path`; how the body goes with steps of a walk
    waits, face                   what she does while she waits; lids, smiles and eyes
    request, two, performance     what the user wants; two on one pad; who dances a chart, and how
    pieces, bake, kept, ends      songs in pieces; the order of work of a piece; the store of baked pieces; where a
                                  cut begins and ends
    smoothing                     paths over time
    quadratic, nonnegative        least squares in bands, with limits, and without negative unknowns

The mirror image of a play gives the mirror image of the motion: where both sides are equal, the leading foot decides
(`Plan.lead`). Numbers are in `configs/motion.yaml` (`settings`) and `configs/gaits` (`gait`), or follow from the rig.
"""

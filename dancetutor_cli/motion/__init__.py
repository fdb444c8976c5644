"""How a play becomes a motion: five stages, one type into each and one out of it. `Context` is what all of them know.

    play.Play                      who steps what, from the solver
      |   play.let_go              without the notes that no person plays
      |   footwork.plan_footwork     rules: step, jump, gallop, hold, bracket, mine, sidestep, walk, shake
    plan.Plan                      when each foot leaves and lands, where, how; turns; palms; walks; contacts
      |   swing.foot_path.both_feet  where a foot is at any time
      |   trajectory.body.body_trajectory   balance, height, facing, reach, counter-rotation, beat bounce
    trajectory.body.Trajectory     the body over the feet at even times
      |   ik.targets.ik_targets      where pelvis, shoulders, hands and feet shall be
    ik.full_body.Targets
      |   ik.full_body.solve         all joints at once
    ik.full_body.Poses             local rotations and root
      |   layers.gaze.look, layers.additive.add_layers, layers.fingers   gaze, breath, blinks, wrists, hands
    model.Motion                   what files, films and the quality report get

No stage calls a later one. Only `bake` orders them: `bake.bake.posed` runs the arrows from a trajectory to poses,
`bake.settle.settle` repeats trajectory and inverse kinematics until both fit (its residuals say how well),
`bake.grips` lays hands on the bar by a rough bake, and hair (`physics.hair`) swings last.

What is true of a play is true of its mirror image: where both sides are equal, the leading foot decides
(`Plan.lead`). Numbers are in `configs/motion.yaml` (`settings`) and `configs/gaits` (`gait`), or follow from the rig.
"""

"""From the body's trajectory to joint rotations: targets of hands, feet and shoulders, and the solver of the chain.

knees, hands                  the direction of knees; palms, hands that hang, and the trunk they hang from
targets                       where pelvis, shoulders, hands and feet must be at each frame: `full_body.Targets`
full_body                     the solver: joint rotations and root of all frames
ankles                        corrections afterwards: ankles within their limits, soles that roll if ankles bend too far
"""

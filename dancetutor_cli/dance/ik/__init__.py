"""From the body's trajectory to joint rotations: targets of hands, feet and shoulders, and the solver of the chain.

knees, hands                  where knees point, how a lean is shared; palms, and hands that hang
targets                       where pelvis, shoulders, hands and feet must be at each frame: `full_body.Targets`
full_body                     the solver: joint rotations and root of all frames
ankles                        afterwards: ankles within their limits, soles that roll if an ankle bends too far
"""

"""From a plan to the body over the feet: its path over the ground, its height, its turns, leans and bends.

posture                       `body_trajectory`: calls the modules below in order, and adds up their results
  |   balance, height           the path of the centre of mass over the ground; its height
  |   legs                      where the body can be over its legs, and how high
  |   facing, momentum          the directions of pelvis, chest and head; the counter-movement to swinging legs
  |   stance                    hips over the foot that stands, where there is time between steps
  |   groove                    a bounce on every beat, a trunk that turns and leans with the music
"""

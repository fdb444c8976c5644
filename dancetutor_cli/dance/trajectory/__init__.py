"""From a plan to the body over the feet: its path over the ground, its height, its turns, leans and bends.

posture                       `body_trajectory`: asks the modules below in turn, and adds up what they return
  |   balance, height           where the centre of mass goes over the ground; how high it is
  |   legs                      where the body goes over its legs, how high they let it be
  |   facing, momentum          which way pelvis, chest and head face; what answers legs that swing
  |   groove                    a give on every beat, a trunk that turns and leans with the music
"""

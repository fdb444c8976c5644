"""The dancer's mesh, skin and colours; a user's character fitted to the rig; dances and captures moved onto them.

characters.load_character     the way in: a character that comes with the program, or a user's file
  |   container, gltf           a .glb with every size checked; its meshes and skeleton
  |   materials                 its materials, as both renderers draw them
  |   surfaces                  its surfaces, closed from behind; what is transparent, cut out
  |   humanoid                  which node is which bone; `characters` fits bones, rest pose and size to the rig
mesh.Character                meshes on a skeleton, the colours of its feet, a second dancer's colours
onto_skeleton                 the dancer's motion on another character
animation, retargeting        a performance danced by characters, for `animate`; a captured motion, for `retarget`
"""

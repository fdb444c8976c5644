"""The parts of the picture in space: stage, dancer, bar, screen and camera; the renderers are in `cpu` and `gl`.

scene, look                   the still scene and the state of one frame; their numbers, from configs/picture.yaml
dancer, visibility            the dancer's state at a moment; her hidden parts
camera, follow                the cameras; those that follow her across a wide pad, or a motion on a bare floor
geometry, props               meshes as flat arrays; bar and screen
renderer, shared              the interface of both renderers and the choice; their common computations
"""

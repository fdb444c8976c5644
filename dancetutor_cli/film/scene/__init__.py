"""The parts of the picture in space: stage, dancer, bar and screen, and the camera; renderers in `cpu` and `gl`.

scene, look                   what stands still and the state of one frame; their numbers, from configs/picture.yaml
dancer, visibility            her state at a moment; what of her is hidden
camera, follow                from where she is seen; a camera that goes with her across a wide pad
geometry, props               meshes as flat arrays; bar and screen
renderer                      the interface of both renderers, the choice, and what they work out alike
"""

"""Motions in files: GLB, VRM, BVH, npz and moves as JSON, in and out.

writers                       which suffix is written by what, for `animate` and `retarget`
glb, bvh, npz, moves_json     the formats; key_times says which keys a joint needs, npz_arrays checks a stranger's .npz
captured                      motions of other skeletons in
"""

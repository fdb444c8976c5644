"""Motions in files: GLB, VRM, BVH, npz and moves as JSON, in and out.

writers                       the writer of each suffix, for `animate` and `retarget`
glb, bvh, npz, moves_json     the formats; key_times says which keys a joint needs, npz_arrays checks untrusted .npz files
captured                      motions of other skeletons in
"""

"""Motions in files: GLB, VRM, BVH, npz and moves as JSON, in and out.

writers                       the writer of each suffix, for `animate` and `retarget`
glb, bvh, npz, moves_json     the formats; npz_arrays checks untrusted .npz files
captured                      reading of motions of other skeletons
"""

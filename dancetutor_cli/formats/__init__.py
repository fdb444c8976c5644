"""Motions in files: GLB, VRM, BVH, npz and moves as JSON, in and out.

writers, animation            which suffix is written by what; what `animate` hands to it
glb, bvh, npz, moves_json     the formats; npz_arrays checks a stranger's .npz
captured, retarget            motions of other skeletons in; the work of `retarget`
"""

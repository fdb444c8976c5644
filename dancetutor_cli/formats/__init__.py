"""Motions in files: GLB, VRM, BVH, npz and moves as JSON, in and out."""

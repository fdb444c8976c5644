"""How the program runs on this machine: which folders it takes code from, and its compiled kernels."""

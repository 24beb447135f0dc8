"""Compiles the kernel, the loops over many worlds, and functions of other packages; keeps what is compiled."""

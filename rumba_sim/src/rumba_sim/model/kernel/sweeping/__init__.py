"""What the brush can reach, and what it sweeps."""

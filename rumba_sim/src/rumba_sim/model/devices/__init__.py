"""What only some robots have, or what only some users ask for: a light bumper, its own docking, laser scans."""

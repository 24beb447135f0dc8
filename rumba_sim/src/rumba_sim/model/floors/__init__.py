"""What of a floor plan a robot of some size can reach and sweep, and what it has swept."""

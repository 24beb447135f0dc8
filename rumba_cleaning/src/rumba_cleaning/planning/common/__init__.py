"""What all stages of a plan share: paths, lines of sight, and how much effort a floor is worth."""

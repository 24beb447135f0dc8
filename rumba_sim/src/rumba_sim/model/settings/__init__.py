"""What a robot is like, figure by figure: body, battery, laser, topics and frames; the files that say so."""

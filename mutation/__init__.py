"""Measures by cosmic-ray how many small faults in the modules that keep the robot safe the unit tests find."""

"""What the node mission_test hears of a run, records of it, and sees at the master."""

"""What robots that clean a floor together leave to each other."""

"""What is wrong with a submission, in words that its author understands."""

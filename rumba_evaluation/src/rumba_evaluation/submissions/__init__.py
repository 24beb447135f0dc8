"""Submissions of strangers: what is taken of them, what is wrong with them, and a sandbox in which they run."""

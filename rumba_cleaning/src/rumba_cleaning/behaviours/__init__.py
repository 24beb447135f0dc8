"""Behaviours for a single task, such as going to a pose or docking, and the controllers that they use."""

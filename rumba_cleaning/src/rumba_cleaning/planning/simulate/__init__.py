"""Tells what a robot sweeps on a route: exactly along it, or as it really drives."""

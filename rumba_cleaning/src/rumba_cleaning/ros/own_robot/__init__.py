"""Nodes beside the cleaner for a robot that is not ours: safe_drive and check_robot."""

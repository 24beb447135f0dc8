"""Paints a scene: functions from plain values to a picture."""

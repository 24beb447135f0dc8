"""An environment in which programs learn to clean: its core needs NumPy alone, its face is that of Gymnasium."""

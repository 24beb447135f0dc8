"""Lists of numbers, bytes and NumPy arrays in messages."""

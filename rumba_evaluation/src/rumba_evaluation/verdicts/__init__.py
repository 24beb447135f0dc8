"""Requirements of a mission, and the verdict on each of them."""

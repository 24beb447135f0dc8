"""The world: robots and obstacles on a floor plan, advanced tick by tick, one world or many."""

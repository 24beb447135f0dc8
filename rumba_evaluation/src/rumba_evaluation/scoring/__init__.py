"""How good a path is that anybody planned: read it, drive it, measure the drive."""

"""The page that tells of one recorded mission."""

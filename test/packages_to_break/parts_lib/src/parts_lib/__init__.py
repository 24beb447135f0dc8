"""A module for other packages."""

GREETING = 'hello from parts_lib'

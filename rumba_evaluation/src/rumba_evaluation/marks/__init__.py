"""Marks for submissions: what graders read, tables, and a class that is marked piece by piece."""

"""Whole missions in process, by the hundred, and the tables and plots made of them."""

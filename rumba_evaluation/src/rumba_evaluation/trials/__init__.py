"""Whole missions in process, many in parallel, and the tables and plots of their results."""

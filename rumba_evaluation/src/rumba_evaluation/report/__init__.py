"""The report of one recorded mission as an HTML page."""

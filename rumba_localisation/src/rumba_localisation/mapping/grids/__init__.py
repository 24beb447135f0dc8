"""The occupancy grid: what scans make of it, how a scan matches it, and the map that is saved of it."""

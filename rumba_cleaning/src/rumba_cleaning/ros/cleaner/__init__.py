"""The node cleaner: behaviours of one robot behind actions and a service."""

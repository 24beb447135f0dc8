"""Words for the state of a battery."""

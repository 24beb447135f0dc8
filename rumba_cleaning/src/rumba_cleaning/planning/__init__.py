"""Plans the route along which a robot cleans a floor."""

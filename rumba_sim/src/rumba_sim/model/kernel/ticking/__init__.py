"""What happens in a tick: wheels, movers, battery, and the order of all."""

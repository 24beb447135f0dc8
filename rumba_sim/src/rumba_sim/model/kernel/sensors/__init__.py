"""What bumper, laser and infrared receive."""

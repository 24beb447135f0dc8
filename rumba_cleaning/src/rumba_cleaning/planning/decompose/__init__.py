"""Parts a floor into regions, and turns it so that lanes lie along its rows."""

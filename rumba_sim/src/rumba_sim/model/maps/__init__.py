"""Maps of map_server, and the floor plans that the model makes of them."""

"""Plans the path along which a floor is cleaned."""

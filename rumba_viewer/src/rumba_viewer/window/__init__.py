"""The widgets of Qt, and what keyboard and mouse do in them."""

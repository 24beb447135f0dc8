"""Messages as JSON and CBOR, their definitions, and the operations of a client in them."""

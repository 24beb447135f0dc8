"""A robot as the cleaner sees it: what its topics say, and what is sent to it."""

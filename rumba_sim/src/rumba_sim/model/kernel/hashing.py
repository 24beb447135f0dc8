"""Numbers that look random, and are the same in each run."""


def scrambled(one: int, other: int) -> int:
    """A hash of two whole numbers from 0 to 2^31: 32 bits."""
    bits = (one * 0x9E3779B1 + other * 0x85EBCA77) & 0xFFFFFFFF
    bits = ((bits ^ (bits >> 15)) * 0x2C1B3C6D) & 0xFFFFFFFF
    return bits ^ (bits >> 13)

"""Ranges of a laser as whole millimetres."""

import numpy as np

NOTHING = -1


def to_millimetres(ranges: np.ndarray) -> np.ndarray:
    """Return float32 ranges [m] as int32 [mm], the dtype that int32[] needs; infinity becomes NOTHING."""
    return np.where(np.isfinite(ranges), np.rint(1000.0 * ranges), NOTHING).astype(np.int32)


def nearest(millimetres: np.ndarray) -> int:
    """Return the least distance [mm]; NOTHING if there is none."""
    seen = millimetres[millimetres != NOTHING]
    return int(seen.min()) if seen.size else NOTHING

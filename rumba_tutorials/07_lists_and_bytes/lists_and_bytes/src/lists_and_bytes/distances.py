"""Ranges of a laser in metres as whole millimetres, and back."""

import numpy as np

NOTHING = -1


def to_millimetres(ranges: np.ndarray) -> np.ndarray:
    """float32 ranges [m], inf where nothing is near, as int32 [mm], NOTHING there: int32[] needs exactly that dtype."""
    return np.where(np.isfinite(ranges), np.rint(1000.0 * ranges), NOTHING).astype(np.int32)


def nearest(millimetres: np.ndarray) -> int:
    """The least distance [mm]; NOTHING where there is none."""
    seen = millimetres[millimetres != NOTHING]
    return int(seen.min()) if seen.size else NOTHING

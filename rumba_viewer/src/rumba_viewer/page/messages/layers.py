"""What a map contains besides the cells of /map, in few numbers."""

from typing import Any, Dict, List, Optional, Sequence

import numpy as np

from rumba_sim.model.common.geometry import Pose


def described(width: int, height: int, layers: Dict[str, Optional[Any]], docks: Sequence[Pose]) -> Dict[str, Any]:
    """Layers of a map of a width and a height [cells], by their names, and poses of docks, as JSON."""
    return {'width': width, 'height': height,
            **{name: runs(layer) if layer is not None else [] for name, layer in layers.items()},
            'docks': [dock._asdict() for dock in docks]}


def runs(layer: Any) -> List[int]:
    """Lengths of runs of equal cells of a layer, bool (rows, columns), row by row; the first run is one of False."""
    cells = np.append(np.zeros(1, bool), np.ravel(layer))
    ends = np.append(np.flatnonzero(cells[1:] != cells[:-1]), cells.size - 1)
    return [int(length) for length in np.diff(ends, prepend=0)]

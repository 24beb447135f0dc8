"""The tree of coordinate frames, with the newest transform between each and its parent."""

from typing import Dict, List, NamedTuple, Optional, Tuple

Vector = Tuple[float, float, float]
Quaternion = Tuple[float, float, float, float]  # x, y, z, w
MOST_LEVELS = 100  # of the tree; if there are more, it has a loop


class Transform(NamedTuple):
    """Where a frame is in another one.

    Attributes:
        shift: of its origin [m].
        turn: of its axes, a unit quaternion.
        stamp: seconds and nanoseconds.
    """

    shift: Vector = (0.0, 0.0, 0.0)
    turn: Quaternion = (0.0, 0.0, 0.0, 1.0)
    stamp: Tuple[int, int] = (0, 0)


def _times(one: Quaternion, other: Quaternion) -> Quaternion:
    ax, ay, az, aw = one
    bx, by, bz, bw = other
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def _inverse(turn: Quaternion) -> Quaternion:
    x, y, z, w = turn
    return 0.0 - x, 0.0 - y, 0.0 - z, w  # no negative zeros, which JSON would show


def _turned(vector: Vector, turn: Quaternion) -> Vector:
    x, y, z, _ = _times(_times(turn, (*vector, 0.0)), _inverse(turn))
    return x, y, z


def product(outer: Transform, inner: Transform) -> Transform:
    """Where a frame is in the outermost of three; the stamp is the newer of both."""
    x, y, z = _turned(inner.shift, outer.turn)
    a, b, c = outer.shift
    return Transform((a + x, b + y, c + z), _times(outer.turn, inner.turn), max(outer.stamp, inner.stamp))


def inverse(transform: Transform) -> Transform:
    """Where the outer frame is in the inner one."""
    turn = _inverse(transform.turn)
    x, y, z = _turned(transform.shift, turn)
    return Transform((0.0 - x, 0.0 - y, 0.0 - z), turn, transform.stamp)


class Tree:
    """The frames that are known."""

    def __init__(self) -> None:
        """Know none."""
        self._parents: Dict[str, Tuple[str, Transform]] = {}  # by child

    def clear(self) -> None:
        """Forget all."""
        self._parents.clear()

    def put(self, parent: str, child: str, transform: Transform) -> None:
        """Take where a frame is in its parent."""
        self._parents[child] = parent, transform

    def between(self, target: str, source: str) -> Optional[Transform]:
        """Where the frame `source` is in the frame `target`; None if they are not connected."""
        up = self._to_root(target)
        ancestors = {name: number for number, (name, _) in enumerate(up)}
        for name, transform in self._to_root(source):
            if name in ancestors:
                return product(inverse(up[ancestors[name]][1]), transform)
        return None

    def _to_root(self, name: str) -> List[Tuple[str, Transform]]:
        """A frame and all frames above it, each with where the first one is in it."""
        found = [(name, Transform())]
        while name in self._parents and len(found) < MOST_LEVELS:
            parent, transform = self._parents[name]
            found.append((parent, product(transform, found[-1][1])))
            name = parent
        return found

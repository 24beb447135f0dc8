"""What a laser tells of the distances that its beams go: noise, systematic errors, what it misses, mixed echoes."""

import math

from rumba_sim.model.kernel import Array, Record

GRAZING = 11.43  # tangent of 85 degrees: a wall that a beam meets at a larger angle to its normal sends no echo back
BEND = 0.1  # of the difference of 1 / distance between the edges of a beam: at a straight wall, their mean is within it


def echo(k: Record, distance: float, normal: float, chance: float, bias: float) -> float:
    """The range that the laser tells for a beam.

    Args:
        k: constants.
        distance: up to what the beam meets [m], at most `range_max`.
        normal: of its noise, standard normal.
        chance: uniform in [0, 1), decides whether there is an echo; 1: it is there.
        bias: systematic error of this laser, in its standard deviations.
    """
    if distance >= k.range_max or chance < missing(k, distance):
        return float(k.too_far)
    told = (distance + max(k.range_noise, k.relative_noise * distance) * normal
            + max(k.range_bias, k.relative_bias * distance) * bias)
    if k.range_step > 0.0:
        told = math.floor(told / k.range_step + 0.5) * k.range_step
    if told >= k.range_max:
        return float(k.too_far)
    return float(told if told >= k.range_min else k.too_near)


def missing(k: Record, distance: float) -> float:
    """Probability that there is no echo from a distance [m]: more beyond the range that the maker promises."""
    if distance <= k.sure_range:
        return float(k.dropouts)
    return float(k.dropouts + (1.0 - k.dropouts) * (distance - k.sure_range) / (k.range_max - k.sure_range))


def wide_echo(k: Record, seen: Array, normal: float, chance: float, bias: float) -> float:
    """The range that the laser tells for a beam that is as wide as it is in truth.

    If a part of it meets something nearer than the rest does, the range is a mixture of both distances, a mixed pixel
    (Hebert and Krotkov 1992); surfaces farther apart than `mixing_depth` do not mix. It is that of the middle then. A
    wall that the beam only grazes is not seen.

    Args, apart from those of `echo`:
        seen: float64 (3), distances along one edge, the middle, and the other edge of the beam.
    """
    one, middle, other = seen[0], seen[1], seen[2]
    near, far = min(one, middle, other), max(one, middle, other)
    if far <= 0.0 or far >= k.range_max or far - near > k.mixing_depth:
        return echo(k, middle, normal, chance, bias)
    if abs(2.0 * one * other - middle * (one + other)) <= 2.0 * BEND * middle * abs(one - other):  # a straight wall
        if far - near > GRAZING * k.beam_width * middle:
            return float(k.too_far)
        return echo(k, middle, normal, chance, bias)
    lost = missing(k, middle)
    if chance < lost:
        return float(k.too_far)
    nearer = int(one - near < far - one) + int(middle - near < far - middle) + int(other - near < far - other)
    share = 0.5 * (nearer - 1.0 + (chance - lost) / (1.0 - lost))
    return echo(k, share * near + (1.0 - share) * far, normal, 1.0, bias)

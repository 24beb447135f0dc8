"""Delta debugging: the shortest sequence of blows that still shows a failure."""

import time

ATTEMPTS = 3  # at the last blow alone


def shortest(numbers, shows, seconds):
    """Leave out what is not needed (Zeller's ddmin), as long as there is time.

    Args:
        numbers: the blows after which the failure was seen, in order; the last one was struck when it was seen.
        shows: whether a sequence shows the failure, tried on a fresh ground.
        seconds: how long to look [s].

    Returns:
        the shortest sequence found, and whether the failure was seen again at all.
    """
    end = time.monotonic() + seconds
    numbers = list(numbers)
    # Most failures need their last blow alone, and some of these luck besides.
    if any(shows(numbers[-1:]) for _ in range(ATTEMPTS)):
        return numbers[-1:], True
    if len(numbers) == 1 or not shows(numbers):
        return numbers, False
    parts = 2
    while len(numbers) > 1 and time.monotonic() < end:
        size = max(len(numbers) // parts, 1)
        for first in range(0, len(numbers), size):
            rest = numbers[:first] + numbers[first + size:]
            if rest and time.monotonic() < end and shows(rest):
                numbers, parts = rest, max(parts - 1, 2)
                break
        else:
            if size == 1:
                break
            parts = min(2 * parts, len(numbers))
    return numbers, True

"""Provokes races: several threads that call functions again and again, and change places as often as Python can."""

import sys
import threading


def hammer(first, *others):
    """Call `first` once, and the others in threads of their own again and again meanwhile; raises what one raised."""
    errors = []
    is_over = threading.Event()

    def repeat(act):
        try:
            while not is_over.is_set():
                act()
        except Exception as error:
            errors.append(error)
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    threads = [threading.Thread(target=repeat, args=[act]) for act in others]
    try:
        for thread in threads:
            thread.start()
        first()
    finally:
        is_over.set()
        for thread in threads:
            thread.join()
        sys.setswitchinterval(before)
    if errors:
        raise errors[0]

"""Plants a fault into a node, and what faults are made of.

A node imports all its modules before it calls `node.run`: there the fault is planted.
"""

import importlib.abc
import importlib.machinery
import math
import os
import sys

DIED = 3  # exit code
COMMANDS = ('forgets_rows', 'repeats_what_is_no_id')  # faults of programs that are no nodes: they are planted at once


def plant(name):
    """Plant a fault as soon as the program begins its work."""
    import faults
    fault = getattr(faults, name)
    if name in COMMANDS:
        fault()
        return

    def in_node(module):
        run = module.run

        def planted(*arguments, **options):
            fault()
            run(*arguments, **options)
        module.run = planted
    after_import('rumba_sim.ros.running.node', in_node)


def after_import(name, change):
    """Have a module changed right after its import."""
    class Loader(importlib.machinery.SourceFileLoader):
        def exec_module(self, module):
            super().exec_module(module)
            change(module)

    class Finder(importlib.abc.MetaPathFinder):
        def find_spec(self, fullname, path, target=None):
            if fullname != name:
                return None
            spec = importlib.machinery.PathFinder.find_spec(fullname, path)
            spec.loader = Loader(spec.loader.name, spec.loader.path)
            return spec
    sys.meta_path.insert(0, Finder())


def before(owner, name, act):
    """Have a function called with the arguments of a method or function, before that."""
    usual = getattr(owner, name)

    def changed(*arguments, **options):
        act(*arguments)
        return usual(*arguments, **options)
    setattr(owner, name, changed)


def after(owner, name, act):
    """Have a function called with the result of a method or function; what it returns takes its place."""
    usual = getattr(owner, name)
    setattr(owner, name, lambda *arguments, **options: act(usual(*arguments, **options)))


def is_odd(message):
    """Whether a message has a number that is none."""
    return any(isinstance(value, float) and not math.isfinite(value) for value in _values(message))


def texts(message):
    """The texts in a message."""
    return [value for value in _values(message) if isinstance(value, str)]


def _values(message):
    for name in getattr(message, '__slots__', ()):
        value = getattr(message, name)
        yield from _values(value) if hasattr(value, '__slots__') else [value]


def on_message(act):
    """Have a function called with each message that a subscriber gets."""
    from rospy.topics import _SubscriberImpl
    before(_SubscriberImpl, '_invoke_callback', lambda _, message, *__: act(message))


def die(*_):
    """End at once."""
    os._exit(DIED)

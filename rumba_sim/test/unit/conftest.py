"""Hypothesis tries the same examples in every run, has no time limit, and writes no files."""

import signal

import hypothesis

hypothesis.settings.register_profile('rumba', derandomize=True, database=None, deadline=None)
hypothesis.settings.load_profile('rumba')

# If a shell runs the tests in the background, they and the processes that they start would ignore Ctrl-C.
signal.signal(signal.SIGINT, signal.default_int_handler)

"""The same examples in every run, on a machine of any speed, and nothing written beside the tests."""

import hypothesis

hypothesis.settings.register_profile('rumba', derandomize=True, database=None, deadline=None)
hypothesis.settings.load_profile('rumba')

"""Names that become parts of the names of topics."""

from typing import Any

import rosgraph

from rumba_sim.model.common.errors import ConfigError


def check_names(settings: Any, *names: str) -> None:
    """Check that settings, given by their names, can be parts of the name of a topic.

    Raises:
        ConfigError: one of them is not a valid base name of ROS.
    """
    for name in names:
        value = getattr(settings, name)
        if not rosgraph.names.is_legal_base_name(value):
            raise ConfigError(f'{name} is {value!r}: must be letters, digits and _, beginning with a letter')

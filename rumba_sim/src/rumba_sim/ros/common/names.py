"""Names of which topics are made."""

from typing import Any

import rosgraph

from rumba_sim.model.errors import ConfigError


def check_names(settings: Any, *names: str) -> None:
    """Refuse settings, by their names, that cannot be a part of a topic's name.

    Raises:
        ConfigError: one is no base name of ROS.
    """
    for name in names:
        value = getattr(settings, name)
        if not rosgraph.names.is_legal_base_name(value):
            raise ConfigError(f'{name} is {value!r}: must be letters, digits and _, beginning with a letter')

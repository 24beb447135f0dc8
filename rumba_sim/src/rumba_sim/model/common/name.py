"""Names of robots and obstacles."""

import re
from typing import Any

from rumba_sim.model.common.errors import WorldError, quoted

LONGEST_NAME = 64  # [characters]
NAME = re.compile(rf'[A-Za-z]\w{{0,{LONGEST_NAME - 1}}}', re.ASCII)


def check_name(name: Any) -> None:
    """Check the name of a robot or an obstacle.

    Raises:
        WorldError: it is no text, is too long, or has other characters than letters, digits and _.
    """
    if not isinstance(name, str) or not NAME.fullmatch(name):
        raise WorldError(f'{quoted(name)} is not a valid name: must be 1 to {LONGEST_NAME} letters, digits and _, '
                         'beginning with a letter')

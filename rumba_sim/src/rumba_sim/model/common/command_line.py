"""What the commands have in common: exit codes, and errors in one line."""

import argparse
from typing import NoReturn

ERROR, BAD_INPUT, INTERRUPTED = 1, 2, 130


class Parser(argparse.ArgumentParser):
    """Reports an error in one line."""

    def error(self, message: str) -> NoReturn:
        """Print the line and exit."""
        self.exit(BAD_INPUT, f'{self.prog}: {message}; see --help\n')

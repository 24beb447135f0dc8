"""Where pictures of the field are written: any node may set the name, so it must not lead to a file of anybody else."""

import os
import pathlib
import re
import tempfile

from PIL import Image

from turtlesim.model.errors import TurtlesimError

NAME = re.compile(r'\w[\w.-]{0,90}\.png', re.ASCII)
SIGNATURE = b'\x89PNG\r\n\x1a\n'


def folder() -> pathlib.Path:
    """Return the folder of the pictures, below the one in which ROS keeps its logs."""
    return pathlib.Path(os.environ.get('ROS_HOME') or pathlib.Path('~/.ros').expanduser(), 'turtlesim').absolute()


def is_name(value: object) -> bool:
    """Whether a value is the name of a picture."""
    return type(value) is str and NAME.fullmatch(value) is not None


def save(picture: Image.Image, name: str) -> pathlib.Path:
    """Write a picture and return its path; a picture of that name is replaced, any other file is not.

    Args:
        picture: to be written.
        name: a string for which `is_name` holds.

    Raises:
        TurtlesimError: there is a file of that name, and it is not a picture.
        OSError: the picture cannot be written.
    """
    path = folder() / name
    if path.is_symlink() or path.exists() and not _is_picture(path):
        raise TurtlesimError(f'{path} is not a picture: delete it, or choose another name')
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(dir=path.parent, suffix='.part', delete=False) as part:
        try:
            picture.save(part, 'PNG')
            os.replace(part.name, path)
        except BaseException:
            os.unlink(part.name)
            raise
    return path


def _is_picture(path: pathlib.Path) -> bool:
    if not path.is_file():
        return False
    with path.open('rb') as file:
        return file.read(len(SIGNATURE)) == SIGNATURE

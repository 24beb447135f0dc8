"""Images of maps as arrays of brightness.

PGM is read here, since old versions of Pillow read only some kinds of it; Pillow reads all other formats.
"""

from __future__ import annotations

import enum
import re
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from PIL import Image, UnidentifiedImageError

from rumba_sim.model.errors import MapError

if TYPE_CHECKING:  # NumPy 1.17 of Ubuntu 20.04 has no numpy.typing
    from numpy.typing import NDArray

MAX_PIXELS = 150_000_000  # below the limit of Pillow; a decoded image of this size takes up to a gigabyte
STRIP = 256  # rows
PGM_HEADER = re.compile(rb'P([25])' + 3 * rb'(?:\s+#[^\n]*(?=\n))*\s+(\d{1,9})' + rb'\s')
PGM_LIMIT = 65535


class Picture(NamedTuple):
    """Brightness of the pixels of an image.

    Attributes:
        levels: unsigned integers (rows, columns), row 0 at the top; 0 is black.
        white: level of white.
    """

    levels: NDArray[Any]
    white: int


class Alpha(enum.Enum):
    """How the transparency of an image is used."""

    AVERAGE = 'alpha counts as one more colour, as in mode trinary of map_server'
    IGNORE = 'alpha is ignored, as in the other modes of map_server'
    ON_WHITE = 'the image is drawn on a white background'


def read(path: str, alpha: Alpha) -> Picture:
    """Read an image file.

    Raises:
        MapError: the file is missing, not an image, truncated, or has more than MAX_PIXELS; the message names it.
    """
    try:
        with open(path, 'rb') as file:
            kind = file.read(2)
            if not kind:
                raise MapError(f'{path}: the file is empty')
            if kind in (b'P2', b'P5'):
                return _read_pgm(path, kind + file.read())
        return _read_other(path, alpha)
    except (OSError, ValueError) as exc:  # ValueError: a path with a null character
        raise MapError(f'{path}: {getattr(exc, "strerror", None) or exc}') from exc


def _check_pixels(path: str, columns: int, rows: int) -> None:
    if rows * columns > MAX_PIXELS:
        raise MapError(f'{path}: {columns} x {rows} pixels are more than {MAX_PIXELS // 1_000_000} million: '
                       'cut the image to the part to be cleaned')
    if rows * columns == 0:
        raise MapError(f'{path}: {columns} x {rows} pixels: the image is empty')


def _read_pgm(path: str, data: bytes) -> Picture:
    header = PGM_HEADER.match(data)
    if header is None:
        raise MapError(f'{path}: the header of this PGM image is damaged')
    columns, rows, white = (int(number) for number in header.groups()[1:])
    _check_pixels(path, columns, rows)
    if not 0 < white <= PGM_LIMIT:
        raise MapError(f'{path}: white is {white} in this PGM image: must be 1 to {PGM_LIMIT}')
    size = rows * columns
    if header.group(1) == b'2':
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # a text that ends early is reported below
            levels = np.fromstring(data[header.end():].decode('latin-1'), dtype=np.int32, count=-1, sep=' ')[:size]
    else:
        sample = np.dtype('>u2' if white > 255 else 'u1')
        stored = min(size, (len(data) - header.end()) // sample.itemsize)
        levels = np.frombuffer(data, sample, stored, header.end())
    if levels.size < size:
        raise MapError(f'{path}: the image is cut short: {levels.size} of its {columns} x {rows} pixels are there')
    return Picture(np.clip(levels, 0, white).astype(np.uint16 if white > 255 else np.uint8).reshape(rows, columns),
                   white)


def _read_other(path: str, alpha: Alpha) -> Picture:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # Pillow warns about large images that are allowed here
            with Image.open(path) as image:
                _check_pixels(path, *image.size)
                return _levels(image, alpha)
    except MapError:
        raise
    except UnidentifiedImageError as exc:
        raise MapError(f'{path}: is not an image of a known format: must be PNG or PGM, for example') from exc
    except Image.DecompressionBombError as exc:
        raise MapError(f'{path}: more than {MAX_PIXELS // 1_000_000} million pixels: '
                       'cut the image to the part to be cleaned') from exc
    except Exception as exc:  # a damaged file can make the decoders of Pillow raise any exception
        raise MapError(f'{path}: the image is damaged: {" ".join(str(exc).split()) or type(exc).__name__}') from exc


def _levels(image: Any, alpha: Alpha) -> Picture:
    if image.mode.startswith('I'):  # 16 bit grey, which some versions of Pillow store in 32 bits
        return Picture(np.clip(np.asarray(image), 0, PGM_LIMIT).astype(np.uint16), PGM_LIMIT)
    if image.mode in ('1', 'L') and 'transparency' not in image.info:
        return Picture(np.asarray(image.convert('L')), 255)
    transparent = 'A' in image.mode or 'transparency' in image.info
    bands = 4 if transparent and alpha is Alpha.AVERAGE else 3
    levels = np.empty((image.height, image.width), np.uint16)
    for top in range(0, image.height, STRIP):  # the whole image at once would be in memory several times
        strip = image.crop((0, top, image.width, min(top + STRIP, image.height)))
        strip = strip.convert('RGBA' if transparent else 'RGB')
        if transparent and alpha is Alpha.ON_WHITE:
            strip = Image.alpha_composite(Image.new('RGBA', strip.size, 'white'), strip)
        levels[top:top + STRIP] = np.asarray(strip)[:, :, :bands].sum(axis=2, dtype=np.uint16)
    return Picture(levels, 255 * bands)

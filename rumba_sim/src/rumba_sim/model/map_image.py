"""Images of maps as arrays of brightness.

PGM is read here, since old versions of Pillow read only some kinds of it; Pillow reads PNG. All other formats are
refused: some decoders of Pillow start other programs.
"""

from __future__ import annotations

import enum
import os
import re
import warnings
from typing import IO, TYPE_CHECKING, Any, NamedTuple, Optional

import numpy as np
from PIL import Image
from PIL.PngImagePlugin import PngImageFile

from rumba_sim.model.errors import MapError
from rumba_sim.model.regular_file import opened

if TYPE_CHECKING:  # NumPy 1.17 of Ubuntu 20.04 has no numpy.typing
    from numpy.typing import NDArray

MAX_PIXELS = 150_000_000  # a decoded image of this size takes up to a gigabyte
MAX_SIDE = 100_000  # [pixels]
STRIP = 256  # rows
PNG_SIGNATURE = b'\x89PNG\r\n\x1a\n'
PGM_KINDS = (b'P2', b'P5')
PGM_HEADER = re.compile(rb'P([25])' + 3 * rb'(?:\s+#[^\n]*(?=\n))*\s+(\d{1,9})' + rb'\s')
PGM_HEADER_LENGTH = 65536  # [bytes] with its comments
PGM_LIMIT = 65535
NUMBERS = re.compile(rb'[\s\d]*')
PLAIN_LENGTH = 12  # [bytes] of a pixel of a plain PGM image with the space around it


class Picture(NamedTuple):
    """Brightness of the pixels of an image.

    Attributes:
        path: of the file.
        levels: unsigned integers (rows, columns), row 0 at the top; 0 is black.
        white: level of white.
    """

    path: str
    levels: NDArray[Any]
    white: int


class Alpha(enum.Enum):
    """How the transparency of an image is used."""

    AVERAGE = 'alpha counts as one more colour, as in mode trinary of map_server'
    IGNORE = 'alpha is ignored, as in the other modes of map_server'
    ON_WHITE = 'the image is drawn on a white background'


def read(path: str, alpha: Alpha, like: Optional[Picture] = None) -> Picture:
    """Read an image file.

    Args:
        path: path of the file.
        alpha: how its transparency is used.
        like: a picture that must have the same size, if any.

    Raises:
        MapError: the file is missing, not a PNG or PGM image, truncated, larger than MAX_PIXELS or MAX_SIDE, or
            differs in size from `like`; the message names it.
    """
    with opened(path, MapError) as file:
        try:
            signature = file.read(len(PNG_SIGNATURE))
            file.seek(0)
            if not signature:
                raise MapError(f'{path}: the file is empty')
            if signature[:2] in PGM_KINDS:
                return _read_pgm(path, file, like)
            if signature == PNG_SIGNATURE:
                return _read_png(path, file, alpha, like)
        except OSError as exc:
            raise MapError(f'{path}: {exc.strerror or exc}') from exc
    raise MapError(f'{path}: is not an image of a known format: must be PNG or PGM')


def _check_size(path: str, columns: int, rows: int, like: Optional[Picture]) -> None:
    """Refuse an image before its pixels are decoded."""
    if like is not None and like.levels.shape != (rows, columns):
        raise MapError(f'{path}: has {columns} x {rows} pixels, '
                       f'{like.path} has {like.levels.shape[1]} x {like.levels.shape[0]}: must be the same')
    if rows * columns > MAX_PIXELS:
        raise MapError(f'{path}: {columns} x {rows} pixels are more than {MAX_PIXELS // 1_000_000} million: '
                       'cut the image to the part to be cleaned')
    if max(rows, columns) > MAX_SIDE:
        raise MapError(f'{path}: has {columns} x {rows} pixels: no side must be longer than {MAX_SIDE}')
    if rows * columns == 0:
        raise MapError(f'{path}: {columns} x {rows} pixels: the image is empty')


def _read_pgm(path: str, file: IO[bytes], like: Optional[Picture]) -> Picture:
    data = file.read(PGM_HEADER_LENGTH)
    header = PGM_HEADER.match(data)
    if header is None:
        raise MapError(f'{path}: the header of this PGM image is damaged')
    columns, rows, white = (int(number) for number in header.groups()[1:])
    _check_size(path, columns, rows, like)
    if not 0 < white <= PGM_LIMIT:
        raise MapError(f'{path}: white is {white} in this PGM image: must be 1 to {PGM_LIMIT}')
    size = rows * columns
    plain = header.group(1) == b'2'
    sample = np.dtype('>u2' if white > 255 else 'u1')
    end = header.end() + size * (PLAIN_LENGTH if plain else sample.itemsize)
    data += file.read(max(0, min(end, os.fstat(file.fileno()).st_size) - len(data)))
    if plain:
        levels = np.fromstring(_numbers(data, header.end()), dtype=np.int32, sep=' ')[:size]
    else:
        stored = min(size, (len(data) - header.end()) // sample.itemsize)
        levels = np.frombuffer(data, sample, stored, header.end())
    if levels.size < size:
        raise MapError(f'{path}: the image is cut short: {levels.size} of its {columns} x {rows} pixels are there')
    levels = np.clip(levels, 0, white).astype(np.uint16 if white > 255 else np.uint8)
    return Picture(path, levels.reshape(rows, columns), white)


def _numbers(data: bytes, begin: int) -> str:
    """The text from a place on, up to what is neither a number nor a space: NumPy refuses that, or warns of it."""
    found = NUMBERS.match(data, begin)
    return found.group().decode().strip() if found else ''


def _read_png(path: str, file: IO[bytes], alpha: Alpha, like: Optional[Picture]) -> Picture:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # Pillow warns about what it corrects
            with PngImageFile(file) as image:
                _check_size(path, image.width, image.height, like)
                return _decoded(path, image, alpha)
    except MapError:
        raise
    except Exception as exc:  # a damaged file can make the decoder raise any exception
        raise MapError(f'{path}: the image is damaged: {" ".join(str(exc).split()) or type(exc).__name__}') from exc


def _decoded(path: str, image: Any, alpha: Alpha) -> Picture:
    deep = image.mode.startswith('I')  # 16 bit grey, which some versions of Pillow store in 32 bits
    transparent = 'A' in image.mode or 'transparency' in image.info
    grey = deep or image.mode in ('1', 'L') and not transparent
    bands = 1 if grey else 4 if transparent and alpha is Alpha.AVERAGE else 3
    levels = np.empty((image.height, image.width), np.uint8 if grey and not deep else np.uint16)
    for top in range(0, image.height, STRIP):  # the whole image at once would be in memory several times
        strip = image.crop((0, top, image.width, min(top + STRIP, image.height)))
        if deep:
            strip = np.clip(np.asarray(strip), 0, PGM_LIMIT)
        elif grey:
            strip = np.asarray(strip.convert('L'))
        else:
            strip = _colours(strip, transparent, alpha)[:, :, :bands].sum(axis=2, dtype=np.uint16)
        levels[top:top + STRIP] = strip
    return Picture(path, levels, PGM_LIMIT if deep else 255 * bands)


def _colours(strip: Any, transparent: bool, alpha: Alpha) -> NDArray[np.uint8]:
    strip = strip.convert('RGBA' if transparent else 'RGB')
    if transparent and alpha is Alpha.ON_WHITE:
        strip = Image.alpha_composite(Image.new('RGBA', strip.size, 'white'), strip)
    return np.asarray(strip)

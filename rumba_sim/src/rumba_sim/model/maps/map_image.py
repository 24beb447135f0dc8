"""Images of maps as arrays of brightness.

What a file holds decides, not its name. PGM and PPM are read here, since old versions of Pillow read only some kinds
of them; Pillow reads PNG, BMP and JPEG. All other formats are refused: some decoders of Pillow start other programs.
"""

from __future__ import annotations

import enum
import os
import re
import warnings
from typing import IO, TYPE_CHECKING, Any, NamedTuple, Optional, Type

import numpy as np
from PIL import Image
from PIL.BmpImagePlugin import BmpImageFile
from PIL.ImageFile import ImageFile
from PIL.JpegImagePlugin import JpegImageFile
from PIL.PngImagePlugin import PngImageFile

from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.regular_file import opened

if TYPE_CHECKING:  # NumPy 1.17 of Ubuntu 20.04 has no numpy.typing
    from numpy.typing import NDArray

MAX_PIXELS = 150_000_000  # a decoded image of this size takes up to a gigabyte
MAX_SIDE = 100_000  # [pixels]
STRIP = 256  # rows
DECODERS = {b'\x89PNG\r\n\x1a\n': PngImageFile, b'BM': BmpImageFile, b'\xff\xd8\xff': JpegImageFile}  # by signature
SIGNATURE_LENGTH = 8
NETPBM = {b'P2': 'PGM', b'P5': 'PGM', b'P3': 'PPM', b'P6': 'PPM'}
NETPBM_HEADER = re.compile(rb'P([2356])' + 3 * rb'(?:\s+#[^\n]*(?=\n))*\s+(\d{1,9})' + rb'\s')
NETPBM_HEADER_LENGTH = 65536  # [bytes] with its comments
PLAIN = (b'2', b'3')  # as text
DEEPEST = 65535
NUMBERS = re.compile(rb'[\s\d]*')
PLAIN_LENGTH = 12  # [bytes] of a number of a plain image with the space around it


class Picture(NamedTuple):
    """Brightness of the pixels of an image.

    Attributes:
        path: of the file.
        levels: unsigned integers (rows, columns), row 0 at the top; 0 is black.
        white: level of white.
        format: of the file: PNG, PGM, PPM, BMP or JPEG.
    """

    path: str
    levels: NDArray[Any]
    white: int
    format: str


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
        MapError: the file is missing, not an image of these formats, truncated, larger than MAX_PIXELS or MAX_SIDE, or
            differs in size from `like`; the message names it.
    """
    with opened(path, MapError) as file:
        try:
            signature = file.read(SIGNATURE_LENGTH)
            file.seek(0)
            if not signature:
                raise MapError(f'{path}: the file is empty')
            if signature[:2] in NETPBM:
                return _read_netpbm(path, file, NETPBM[signature[:2]], like)
            for begin, decoder in DECODERS.items():
                if signature.startswith(begin):
                    return _read_decoded(path, file, decoder, alpha, like)
        except OSError as exc:
            raise MapError(f'{path}: {exc.strerror or exc}') from exc
    raise MapError(f'{path}: is not an image of a known format: must be PNG, PGM, PPM, BMP or JPEG')


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


def _read_netpbm(path: str, file: IO[bytes], name: str, like: Optional[Picture]) -> Picture:
    data = file.read(NETPBM_HEADER_LENGTH)
    header = NETPBM_HEADER.match(data)
    if header is None:
        raise MapError(f'{path}: the header of this {name} image is damaged')
    columns, rows, white = (int(number) for number in header.groups()[1:])
    _check_size(path, columns, rows, like)
    if not 0 < white <= DEEPEST:
        raise MapError(f'{path}: white is {white} in this {name} image: must be 1 to {DEEPEST}')
    bands = 3 if name == 'PPM' else 1
    size = rows * columns * bands
    plain = header.group(1) in PLAIN
    sample = np.dtype('>u2' if white > 255 else 'u1')
    end = header.end() + size * (PLAIN_LENGTH if plain else sample.itemsize)
    data += file.read(max(0, min(end, os.fstat(file.fileno()).st_size) - len(data)))
    if plain:
        levels = np.fromstring(_numbers(data, header.end()), dtype=np.int32, sep=' ')[:size]
    else:
        stored = min(size, (len(data) - header.end()) // sample.itemsize)
        levels = np.frombuffer(data, sample, stored, header.end())
    if levels.size < size:
        raise MapError(f'{path}: the image is cut short: {levels.size // bands} of its {columns} x {rows} pixels are '
                       'there')
    levels = np.clip(levels, 0, white).astype(np.uint16 if white > 255 else np.uint8)
    if bands == 1:
        return Picture(path, levels.reshape(rows, columns), white, name)
    wide = np.uint16 if white * bands <= DEEPEST else np.uint32
    return Picture(path, levels.reshape(rows, columns, bands).sum(axis=2, dtype=wide), white * bands, name)


def _numbers(data: bytes, begin: int) -> str:
    """The text from a place on, up to what is neither a number nor a space: NumPy refuses that, or warns of it."""
    found = NUMBERS.match(data, begin)
    return found.group().decode().strip() if found else ''


def _read_decoded(path: str, file: IO[bytes], decoder: Type[ImageFile], alpha: Alpha,
                  like: Optional[Picture]) -> Picture:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # Pillow warns about what it corrects
            with decoder(file) as image:
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
            strip = np.clip(np.asarray(strip), 0, DEEPEST)
        elif grey:
            strip = np.asarray(strip.convert('L'))
        else:
            strip = _colours(strip, transparent, alpha)[:, :, :bands].sum(axis=2, dtype=np.uint16)
        levels[top:top + STRIP] = strip
    return Picture(path, levels, DEEPEST if deep else 255 * bands, image.format)


def _colours(strip: Any, transparent: bool, alpha: Alpha) -> NDArray[np.uint8]:
    strip = strip.convert('RGBA' if transparent else 'RGB')
    if transparent and alpha is Alpha.ON_WHITE:
        strip = Image.alpha_composite(Image.new('RGBA', strip.size, 'white'), strip)
    return np.asarray(strip)

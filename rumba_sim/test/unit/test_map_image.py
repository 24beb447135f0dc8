"""Images of maps: every format, whole and damaged."""

import os
import struct
import zlib

import numpy as np
import pytest
from PIL import Image
from sheets import CUT, PIXELS, B, G, W, grid, write

from rumba_sim.model.common.errors import MapError
from rumba_sim.model.maps import map_file, map_image
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, UNKNOWN


def test_a_layer_with_a_transparent_background_marks_what_is_drawn(tmp_path):
    layer = np.zeros(PIXELS.shape + (4,), np.uint8)
    layer[1, 3] = (90, 20, 60, 255)
    layer[2, 3] = (90, 20, 60, 60)
    layer[3, 3] = (255, 255, 255, 255)
    Image.fromarray(layer).save(str(tmp_path / 'carpet.png'))
    assert np.argwhere(map_file.load(write(tmp_path, carpet='carpet.png')).carpet).tolist() == [[5, 2]]


def netpbm(kind, pixels, white, comment=b''):
    """The bytes of a PGM image, or of a PPM image of (rows, columns, 3) pixels."""
    head = b'%s\n%s%d %d\n%d\n' % (kind, comment, pixels.shape[1], pixels.shape[0], white)
    pixels = pixels.reshape(len(pixels), -1)
    if kind in (b'P2', b'P3'):
        return head + b'\n'.join(b' '.join(b'%d' % level for level in row) for row in pixels)
    return head + pixels.astype('>u2' if white > 255 else 'u1').tobytes()


@pytest.mark.parametrize('data', [
    netpbm(b'P5', PIXELS, 255),
    netpbm(b'P5', PIXELS, 255, b'# CREATOR: # a mapper # 0.050 m/pix\n# \n'),
    netpbm(b'P2', PIXELS, 255, b'# 99 99\n'),
    netpbm(b'P5', PIXELS.astype(int) * 257, 65535),
    netpbm(b'P2', PIXELS.astype(int) * 257, 65535),
    netpbm(b'P5', PIXELS // 2, 127),
    netpbm(b'P5', np.where(PIXELS == W, 200, PIXELS // 2), 127),
    netpbm(b'P5', PIXELS.astype(int) * 4, 1020),
    netpbm(b'P5', PIXELS, 255) + b'what follows is another image',
], ids=['raw', 'comments', 'plain', 'raw 16 bit', 'plain 16 bit', 'white is 127', 'lighter than white',
        'white is 1020', 'longer'])
def test_each_kind_of_pgm_is_the_same_map(tmp_path, data):
    (tmp_path / 'flat.pgm').write_bytes(data)
    assert map_file.load(write(tmp_path, image='flat.pgm')).occupancy.tolist() == grid(CUT).tolist()


COLOURS = np.stack([np.where(PIXELS == G, 250, PIXELS), PIXELS, np.where(PIXELS == G, 160, PIXELS)], axis=2)


@pytest.mark.parametrize('data', [
    netpbm(b'P6', COLOURS.astype(np.uint8), 255),
    netpbm(b'P3', COLOURS, 255, b'# a drawing\n'),
    netpbm(b'P6', COLOURS.astype(int) * 257, 65535),
], ids=['raw', 'plain', 'raw 16 bit'])
def test_a_ppm_counts_by_the_mean_of_its_colours(tmp_path, data):
    (tmp_path / 'flat.ppm').write_bytes(data)
    assert map_file.load(write(tmp_path, image='flat.ppm')).occupancy.tolist() == grid(CUT).tolist()


@pytest.mark.parametrize('kind, options', [('BMP', {}), ('JPEG', {'quality': 100}), ('PNG', {}), ('PPM', {})])
@pytest.mark.parametrize('is_coloured', [False, True])
def test_what_an_image_holds_decides_on_its_format_and_not_its_name(tmp_path, kind, options, is_coloured):
    pixels = np.kron(PIXELS, np.ones((8, 8), np.uint8))  # blocks of JPEG
    Image.fromarray(np.stack([pixels] * 3, axis=2) if is_coloured else pixels).save(
        str(tmp_path / 'image.tif'), kind, **options)
    plan = map_file.load(write(tmp_path, image='image.tif'))
    assert plan.occupancy.tolist() == grid(pixels[7:49, 15:41]).tolist()


def palette(pixels):
    """An image with a palette in an unusual order."""
    image = Image.fromarray((pixels == W).astype(np.uint8) + 2 * (pixels == G).astype(np.uint8), 'L').convert('P')
    image.putdata([{W: 1, B: 2, G: 0}[level] for level in pixels.ravel()])
    image.putpalette([250, G, 160] + [W] * 3 + [B] * 3 + [0] * 759)
    return image


@pytest.mark.parametrize('image', [
    Image.fromarray(PIXELS),
    palette(PIXELS),
    Image.fromarray(np.stack([PIXELS] * 3, axis=2)),
    Image.fromarray(COLOURS.astype(np.uint8)),
    Image.fromarray(PIXELS.astype(np.uint16) * 257),
], ids=['grey', 'palette', 'RGB', 'colours', '16 bit'])
def test_each_kind_of_png_is_the_same_map(tmp_path, image):
    assert map_file.load(write(tmp_path, image, free_thresh=0.19)).occupancy.tolist() == grid(CUT).tolist()


def test_an_opaque_image_is_the_same_map_in_mode_scale(tmp_path):
    opaque = np.stack([PIXELS] * 3 + [np.full_like(PIXELS, 255)], axis=2)
    assert map_file.load(write(tmp_path, opaque, mode='scale')).occupancy.tolist() == grid(CUT).tolist()


@pytest.mark.parametrize('kind', ['colour', '16 bit', 'grey'])
def test_a_tall_image_is_read_to_its_last_row(tmp_path, kind):
    pixels = np.kron(PIXELS, np.ones((150, 1), np.uint8))
    pixels[0, 2] = pixels[-1, 3] = W  # nothing is cut from top and bottom
    image = {'colour': np.stack([pixels] * 3, axis=2), '16 bit': pixels.astype(np.uint16) * 257, 'grey': pixels}[kind]
    plan = map_file.load(write(tmp_path, Image.fromarray(image), resolution=2.0))
    assert plan.occupancy.tolist() == grid(pixels)[:, 1:].tolist()


def test_an_image_of_one_bit_has_walls_and_free_cells(tmp_path):
    plan = map_file.load(write(tmp_path, Image.fromarray(PIXELS == W)))
    assert plan.occupancy.tolist() == np.where(CUT[::-1] == W, FREE, OCCUPIED).tolist()


@pytest.mark.parametrize('mode, colour, alpha, value', [
    ('trinary', 255, 255, FREE), ('trinary', 255, 0, UNKNOWN), ('trinary', 0, 255, UNKNOWN),
    ('trinary', 0, 0, OCCUPIED),
    ('scale', 255, 0, FREE), ('scale', 0, 255, OCCUPIED), ('scale', 128, 0, UNKNOWN), ('scale', 128, 255, UNKNOWN)])
def test_transparency_is_a_colour_in_mode_trinary_and_nothing_in_mode_scale(tmp_path, mode, colour, alpha, value):
    pixels = np.full((1, 3, 4), 255, np.uint8)
    pixels[0, 1] = (colour, colour, colour, alpha)
    plan = map_file.load(write(tmp_path, pixels, mode=mode, occupied_thresh=0.75))
    assert plan.occupancy.tolist() == [[FREE, value, FREE]]


def png_header(width, height):
    """A PNG image that consists only of its header."""
    chunk = b'IHDR' + struct.pack('>IIBBBBB', width, height, 8, 0, 0, 0, 0)
    return b'\x89PNG\r\n\x1a\n' + struct.pack('>I', 13) + chunk + struct.pack('>I', zlib.crc32(chunk)) \
        + b'\x00\x00\x00\x00IDAT'


@pytest.mark.parametrize('data, message', [
    (b'', 'the file is empty'),
    (b'not an image', 'is not an image of a known format: must be PNG, PGM, PPM, BMP or JPEG'),
    (b'P5', 'the header of this PGM image is damaged'),
    (b'P5\n3 x\n255\n', 'the header of this PGM image is damaged'),
    (b'P5' + b' #' * 5000, 'the header of this PGM image is damaged'),
    (b'P5\n0 3\n255\n', '0 x 3 pixels: the image is empty'),
    (b'P5\n1 1\n0\n\x00', 'white is 0 in this PGM image: must be 1 to 65535'),
    (b'P5\n1 1\n65536\n\x00', 'white is 65536 in this PGM image'),
    (b'P5\n3 2\n255\n12345', 'the image is cut short: 5 of its 3 x 2 pixels are there'),
    (b'P5\n3 2\n256\n12345', 'the image is cut short: 2 of its 3 x 2 pixels are there'),
    (b'P6\n3 x\n255\n', 'the header of this PPM image is damaged'),
    (b'P6\n3 2\n255\n12345678', 'the image is cut short: 2 of its 3 x 2 pixels are there'),
    (b'P3\n1 1\n255\n9 9', 'the image is cut short: 0 of its 1 x 1 pixels are there'),
    (b'BM' + b'\0' * 60, 'the image is damaged: '), (b'\xff\xd8\xff\xe0' + b'x' * 60, 'the image is damaged: '),
    (b'P2\n1 1\n255\n \n', 'the image is cut short: 0 of its 1 x 1 pixels are there'),
    (b'P2\n3 2\n255\n1 2 3 4', 'the image is cut short: 4 of its 3 x 2 pixels are there'),
    (b'P2\n3 2\n255\n1 2 3 x 5 6', 'the image is cut short: 3 of its 3 x 2 pixels are there'),
    (b'P5\n99999 99999\n255\n', '99999 x 99999 pixels are more than 150 million: cut the image'),
    (png_header(12300, 12300), '12300 x 12300 pixels are more than 150 million: cut the image'),
    (png_header(99999, 99999), '99999 x 99999 pixels are more than 150 million: cut the image'),
    (png_header(200_000, 1), 'has 200000 x 1 pixels: no side must be longer than 100000'),
    (b'P5\n3 200000\n255\n', 'has 3 x 200000 pixels: no side must be longer than 100000'),
    (png_header(300, 300), '.*truncated|the image is damaged'),
], ids=lambda value: repr(value[:20]))
def test_a_bad_image_is_named(tmp_path, data, message):
    (tmp_path / 'bad.png').write_bytes(data)
    path = write(tmp_path, image='bad.png')
    with pytest.raises(MapError, match=f'^{path}: image: {tmp_path}/bad.png: {message}') as caught:
        map_file.load(path)
    assert '\n' not in str(caught.value)


@pytest.mark.parametrize('format', ['EPS', 'GIF', 'TIFF', 'PDF', 'ICO', 'TGA'])
def test_other_formats_are_refused_and_start_no_other_program(tmp_path, monkeypatch, format):
    (tmp_path / 'gs').write_text(f'#!/bin/sh\ntouch {tmp_path}/started\n')
    (tmp_path / 'gs').chmod(0o755)
    monkeypatch.setenv('PATH', str(tmp_path), prepend=os.pathsep)
    Image.fromarray(np.stack([PIXELS] * 3, axis=2)).save(str(tmp_path / 'image'), format)
    with pytest.raises(MapError, match=f'{tmp_path}/image: is not an image of a known format: must be PNG, PGM, PPM, '
                                       'BMP or JPEG$'):
        map_file.load(write(tmp_path, image='image'))
    assert not (tmp_path / 'started').exists()


@pytest.mark.parametrize('kind', ['PNG', 'BMP', 'JPEG'])
def test_a_truncated_image_is_refused(tmp_path, kind):
    path = write(tmp_path)
    Image.fromarray(np.random.default_rng(0).integers(0, 255, (90, 90)).astype(np.uint8)).save(
        str(tmp_path / 'flat.png'), kind)
    whole = (tmp_path / 'flat.png').read_bytes()
    (tmp_path / 'flat.png').write_bytes(whole[:len(whole) // 2])
    with pytest.raises(MapError, match=f'^{path}: image: {tmp_path}/flat.png: .*truncated'):
        map_file.load(path)


def test_any_error_of_a_decoder_becomes_one_line(tmp_path, monkeypatch):
    def fail_to_decode(_):
        raise IndexError('out of\nrange')

    monkeypatch.setattr(map_image, 'DECODERS', {b'\x89PNG': fail_to_decode})
    with pytest.raises(MapError, match=f'{tmp_path}/flat.png: the image is damaged: out of range$'):
        map_file.load(write(tmp_path))


def test_a_layer_of_another_size_is_refused(tmp_path):
    Image.new('L', (4, 9)).save(str(tmp_path / 'cliff.png'))
    with pytest.raises(MapError, match=f'^{tmp_path}/flat.yaml: cliff: {tmp_path}/cliff.png: has 4 x 9 pixels, '
                                       '.*flat.png has 6 x 7'):
        map_file.load(write(tmp_path, cliff='cliff.png'))

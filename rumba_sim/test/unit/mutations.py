"""Hostile files from a seed: mutations of maps, of their images and of settings."""

import struct
import zlib

from sheets import KEYS, PIXELS

SIDES = [0, 1, 2, 3, 7, 255, 4000, 60_000, 100_000, 200_000, 2 ** 31 - 1]
SLOW = range(1_000_000, 150_000_001)  # [pixels] allowed, but too slow for a test
NUMBERS = [
    '0', '1', '-1', '0.05', '.nan', '.inf', '-.inf', '1e300', '1e-300', '5e-324', '1:1:1', '1:1.5', '017', '0b101',
    '1_0', '0x' + 'f' * 5000, '9' * 5000, '1' + ':1' * 900 + '.5', '~', 'true', 'no', "''", '1e', '-', '2020-13-45',
    '2020-01-01']
TREES = [
    '[]', '{}', '[1, 2]', '[0, 0, .nan]', '[0, 0, 0.7]', '[1e9, -1e9, 9e8]', '[[[[]]]]', '{a: {b: [c]}}', '[' * 400,
    '{' * 400, '- ' * 400, '? a', '? [a]', '[' + 'x, ' * 2000 + ']', '&a [1]', '*a', '&a [*a]', '!!set {a, b}']
TEXTS = [
    'flat.png', 'flat.pgm', '.', '..', '/', '/dev/zero', '/dev/tty', 'pipe', 'flat.yaml', 'none.png', "'\x00'", 'é.png',
    r'"\x1b[2J\n"', r'"\0"', r'"\ud800"', 'x' * 5000, '"' + r'\u202e' * 500 + '"', 'trinary', 'scale', 'raw']
TAGS = [
    '!!int ""', '!!int x', '!!float ""', '!!bool x', '!!timestamp x', '!!binary x', '!!null x', '!!str 1', '! 1',
    '!x 1', '!!omap [a: 1]', '!!pairs [a]', '!!python/object:os.system {}', '!!seq 1', '!!map []']
LINES = [
    '---', '...', '%YAML 9.9', '%TAG', '\t', '#', 'a', ': 1', '- 1', "'", '"', '|', '>', '[', '{', '&', '*', '!', '@',
    '`', '\x00', '\x1b[31m', '\ufeff', '\x85', '\u2028', 'docking: [0, 0, 0]', '5: 1', '? [a]\n: 1', '~: 1', '.nan: 1',
    '<<: {image: a}', '<<: [[]]', 'a: &a {b: 1}\n<<: [*a, *a]']
PIXEL_KINDS = [  # bits of a sample, and which samples a pixel has; the last ones do not exist
    (8, 0), (8, 0), (8, 0), (1, 0), (2, 0), (4, 0), (16, 0), (8, 2), (16, 2), (8, 3), (4, 3), (8, 4), (16, 4), (8, 6),
    (16, 6), (7, 0), (8, 1), (0, 0), (8, 255)]
CHUNKS = [
    b'PLTE', b'tRNS', b'gAMA', b'iCCP', b'zTXt', b'tEXt', b'iTXt', b'acTL', b'fcTL', b'fdAT', b'pHYs', b'eXIf', b'IHDR',
    b'IEND', b'IDAT', b'sRGB', b'cHRM', b'ABCD', b'\x00\xff\x00\xff']


def mixed(dice, data):
    """Bytes, some of them replaced, left out or doubled, or cut off."""
    data = bytearray(data)
    for _ in range(dice.choice([0, 0, 1, 3, 20])):
        place = dice.randrange(len(data) + 1)
        data[place:place + dice.choice([0, 1, 1, 4])] = dice.choice([
            b'', b'\xff', b'\x00', b'\n', b' ', b'-', b'9' * 12, bytes([dice.randrange(256)]), data[place:place + 40]])
    return bytes(data[:dice.randrange(len(data) + 1)] if dice.random() < 0.1 else data)


def settings(dice, keys, good):
    """A YAML file with the keys and values of `good`, some of them left out, and hostile values for some of `keys`."""
    lines = [f'{key}: {value}' for key, value in good.items() if dice.random() < 0.98]
    for _ in range(dice.choice([0, 1, 1, 2, 5])):
        value = dice.choice(dice.choice([NUMBERS, TREES, TEXTS, TAGS]))
        line = f'{dice.choice(keys)}: {value}' if dice.random() < 0.9 else dice.choice(LINES)
        lines.insert(dice.randrange(len(lines) + 1), line)
    return mixed(dice, '\n'.join(lines).encode('utf-8', 'surrogatepass'))


def map_file(dice):
    """The YAML file of a map."""
    good = {**KEYS, 'origin': dice.choice([[0, 0, 0], [1, 2, 0.7]]), 'image': dice.choice(['flat.png', 'flat.pgm'])}
    return settings(dice, [*KEYS, 'mode', 'dock', 'start', 'cliff', 'carpet'], good)


def _chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))


def png(dice):
    """A PNG image whose checksums are right, and whose contents are hostile."""
    rows, columns = PIXELS.shape if dice.random() < 0.5 else (dice.choice(SIDES), dice.choice(SIDES))
    if rows * columns in SLOW:
        rows = 3
    header = struct.pack('>IIBBBBB', columns, rows, *dice.choice(PIXEL_KINDS), dice.choice([0] * 9 + [1]),
                         dice.choice([0] * 9 + [1]), dice.choice([0] * 6 + [1, 2]))
    row = b'\x00' + bytes(dice.choice([0, 254]) for _ in range(min(columns, 300))) * dice.choice([1, 2, 3, 4, 8])
    pixels = zlib.compress(row * min(rows, 400))
    chunks = [_chunk(b'IHDR', header), _chunk(b'IDAT', mixed(dice, pixels) if dice.random() < 0.5 else pixels)]
    for _ in range(dice.choice([0, 0, 1, 3])):
        bomb = b'a\x00\x00' + zlib.compress(bytes(dice.choice([9, 2_000_000])), 1)
        data = dice.choice([b'', b'\x00', bomb, bytes(768), bytes(dice.randrange(256) for _ in range(9))])
        chunks.insert(dice.randrange(1, len(chunks) + 1), _chunk(dice.choice(CHUNKS), data))
    return b'\x89PNG\r\n\x1a\n' + b''.join(chunks) + dice.choice([b'', _chunk(b'IEND', b'')])


def pgm(dice):
    """A PGM image with a hostile header."""
    kind = dice.choice([b'P5', b'P5', b'P2', b'P2', b'P1', b'P4', b'P6', b'P7', b'Pf'])
    white = dice.choice([255, 255, 254, 65535, 1, 0, 65536, -1, 99999999999])
    words = [str(number) for number in (PIXELS.shape[1], PIXELS.shape[0], white)]
    if dice.random() < 0.4:
        words[dice.randrange(2)] = str(dice.choice(SIDES))
    space = dice.choice([' ', '\n', '\n# a\n', '\t', ' ' * 500, '\n#\n' * 500, '#', ''])
    pixels = b' '.join(b'%d' % level for level in PIXELS.ravel()) if kind == b'P2' else PIXELS.tobytes()
    return mixed(dice, kind + b'\n' + space.join(words).encode() + b'\n' + pixels * dice.choice([1, 1, 2]))

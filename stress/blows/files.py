"""Blows on fresh nodes: maps, images, settings and arguments that somebody or something spoilt."""

import os
import pathlib
import re
import shutil
import subprocess

import rospkg

from stress.blows import fresh
from stress.member import Member, Role
from stress.scenarios import MAP, SPEED
from stress.values import mutated, noise

STARTS = 3  # fresh nodes of one blow
SIMULATOR = Role('/simulator', 'rumba_sim', 'simulator', '/simulator/tuning/parameter_updates', (f'_speed:={SPEED:g}',),
                 is_world=True)
SCALARS = ('nan', '.inf', '-.inf', '-1', '0', '1e308', '9' * 40, '9' * 5000, 'true', 'null', '~', '[]', '{}', '[1, 2]',
           '"\\e[2J"', 'x' * 5000, '&a [*a]', '!!python/object:os.system', '2001-01-01', '0x10', '1_000', "''", '../..',
           '/dev/zero', '/dev/null', '[[[[[[[[1]]]]]]]]', '1e-320', '{a: {b: c}}', '[.nan, .nan, .nan]', '\t', '%')
NUMBERS = ('0', '1', '2.5', '1e-9', '50', '99.9')  # odd for some parameters, and possible for many
BOMB = 'a: &a [1,1,1,1,1,1,1,1,1]\n' + ''.join(
    f'{new}: &{new} [{",".join([f"*{old}"] * 9)}]\n' for old, new in zip('abcdefg', 'bcdefgh')) + 'seed: *h\n'
IMAGES = ('studio.png', 'studio_carpet.png')
POSTSCRIPT = b'%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n'
SIZES = ((0, 0), (1, 1), (1, 100_000), (60_000, 3), (200_000, 1), (2 ** 31, 2 ** 31), (-1, 5), (3, 3))


def mutated_map(ground, chance, blow):
    """A simulator gets a map whose YAML or image is spoilt."""
    for number in range(STARTS):
        folder = _copy_of_map(ground.folder, number)
        yaml = folder / f'{MAP}.yaml'
        if chance.random() < 0.5:
            what = _spoil_text(yaml, chance)
        else:
            what = _spoil_image(folder / chance.choice(IMAGES), yaml, chance)
        blow.say(f'a map with {what}', faults=1)
        blow.say(fresh.judge(ground, SIMULATOR, [f'_map:={yaml}']))


def _copy_of_map(folder, number):
    copy = folder / f'map{number}'
    shutil.rmtree(copy, ignore_errors=True)
    copy.mkdir()
    for path in pathlib.Path(rospkg.RosPack().get_path('rumba_sim'), 'maps').glob(f'{MAP}*'):
        shutil.copy(path, copy)
    return copy


def _spoil_text(path, chance):
    """Spoil a YAML file; returns how."""
    lines = path.read_text().splitlines()
    number = chance.randrange(len(lines))
    choice = chance.randrange(8)
    if choice < 4:
        scalar = chance.choice(SCALARS)
        lines[number] = re.sub(r': .*', lambda _: f': {scalar}', lines[number])
        what = f'line {number + 1}: {lines[number][:60]!r}'
    elif choice == 4:
        what = f'without line {number + 1}: {lines.pop(number)[:60]!r}'
    elif choice == 5:
        lines.insert(number, lines[number] if chance.random() < 0.5 else f'unknown{number}: 1')
        what = f'one more line {number + 1}: {lines[number][:60]!r}'
    else:
        data = chance.choice((mutated(path.read_bytes(), chance), noise(chance, 300), b'', BOMB.encode(),
                              b'\xff\xfe' + path.read_bytes(), b'[' * 3000, path.read_bytes()[:chance.randrange(200)]))
        path.write_bytes(data)
        return f'{len(data)} bytes, {data[:30]!r}...'
    path.write_text('\n'.join(lines) + '\n')
    return what


def _spoil_image(image, yaml, chance):
    """Spoil an image of a map; returns how."""
    choice = chance.randrange(6)
    if choice < 2:
        image.write_bytes(mutated(image.read_bytes(), chance))
        return f'some bytes of {image.name} changed'
    if choice == 2:
        data = image.read_bytes()
        image.write_bytes(data[:chance.randrange(len(data))])
        return f'{image.name} cut off'
    if choice == 3:
        width, height = chance.choice(SIZES)
        pixels = b'\xff' * min(max(width * height, 0), 10 ** 6)
        image.write_bytes(f'P5 {width} {height} 255\n'.encode() + pixels)
        return f'{image.name} of {width} x {height} pixels'
    image.unlink()
    if choice == 4:
        chance.choice((image.mkdir, lambda: os.mkfifo(image), lambda: image.symlink_to('/dev/zero'), lambda: None))()
        return f'{image.name} no file'
    kind = chance.choice(('eps', 'gif', 'txt', ''))
    other = image.with_name(f'other.{kind}')
    other.write_bytes(POSTSCRIPT if kind == 'eps' else b'GIF89a' + noise(chance, 50))
    yaml.write_text(yaml.read_text().replace(image.name, other.name))
    return f'an image {other.name}'


def mutated_settings(ground, chance, blow):
    """A simulator gets a file of settings that is spoilt."""
    for number in range(STARTS):
        path = ground.folder / f'settings{number}.yaml'
        path.write_text(_settings(ground))
        what = _spoil_text(path, chance)
        blow.say(f'settings with {what}', faults=1)
        blow.say(fresh.judge(ground, SIMULATOR, [f'_config:={path}']))


def _settings(ground):
    """The file that the simulator prints of its settings, without comments."""
    kept = ground.folder / 'settings.yaml'
    if not kept.exists():
        command = Member(SIMULATOR, ground.environment, ground.folder).command[0]
        text = subprocess.run([command, '--config'], env=ground.environment, stdout=subprocess.PIPE, check=True,
                              universal_newlines=True).stdout
        kept.write_text(''.join(f'{line}\n' for line in text.splitlines() if re.match(r' *\w+:', line)))
    return kept.read_text()


# --- arguments --------------------------------------------------------------------------------------------------------

PROGRAMS = {
    Role('/simulator', 'rumba_sim', 'simulator', '/simulator/tuning/parameter_updates', is_world=True):
        ('map', 'speed', 'robots', 'seed', 'step_rate', 'percentage', 'brushes_up', 'config', 'rates/odom',
         'battery/drain', 'drive/radius', 'nothing'),
    Role('/publisher', 'rumba_sim', 'battery_status_publisher', '/rumba/battery_status', pulse='charge'):
        ('rate', 'drain', 'location_x', 'brushes_up', 'percentage'),
    Role('/listener', 'rumba_sim', 'battery_status_listener', '/rumba/battery_status'): ('robot', 'nothing'),
    Role('/cleaner', 'rumba_cleaning', 'cleaner'):
        ('robot', 'map', 'seed', 'strategies', 'strategy', 'autostart', 'target_coverage'),
    Role('/viewer', 'rumba_viewer', 'viewer'): ('robot', 'laser', 'linear', 'style', 'width'),
    Role('/turtlesim', 'turtlesim', 'turtlesim_node', '/turtle1/pose', ('_gui:=false',)): ('speed', 'background_r'),
    Role('/turtlesim_body', 'rumba_sim', 'turtlesim_body'): ('turtle', 'map', 'seed'),
    Role('/mission_test', 'rumba_evaluation', 'mission_test', arguments=('_time_limit:=1',), fails_if_ended=True):
        ('coverage', 'reach', 'docked', 'fields', 'robot', 'patience'),
}
ARGUMENTS = ('--nothing', '-x', '', 'a:=b', '__ns:=/a//b', '__log:=/dev/null/x', '/x:=/y', ':=')


def odd_arguments(ground, chance, blow):
    """Nodes get parameters and arguments full of nonsense."""
    for role in chance.sample(sorted(PROGRAMS), STARTS):
        arguments = [_argument(chance, PROGRAMS[role]) for _ in range(chance.choice((1, 1, 2)))]
        blow.say(f'{role.program} {" ".join(argument[:60] for argument in arguments)!r}', faults=1)
        blow.say(fresh.judge(ground, role, arguments))


def _argument(chance, names):
    value = chance.choice(SCALARS if chance.random() < 0.5 else NUMBERS).strip('"') or ' '
    choice = chance.randrange(6)
    if choice == 0:
        return chance.choice((*ARGUMENTS, value))
    return f'_{chance.choice(names)}:={value}'

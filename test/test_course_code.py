"""What public course code says on this system, and the cures that docs/troubleshooting.md names for it."""

import pytest
from test_troubleshooting import DOC, fails, says
from workspaces import Space, clean_environment

PYTHON = '/usr/bin/python3'
OLD = 'speed = raw_input("speed: ")\nprint "speed is", speed\n'
TABS = 'def f(a):\n    if a:\n\treturn 1\n    return 2\nprint(f(1))\n'
SAID = {  # by message: a program that says so
    "SyntaxError: Missing parentheses in call to 'print'. Did you mean print(...)?": OLD,
    "NameError: name 'raw_input' is not defined": 'speed = raw_input("speed: ")\n',
    "TypeError: can't multiply sequence by non-int of type 'float'": 'print(input() * 2.0)\n',
    'TabError: inconsistent use of tabs and spaces in indentation': TABS}


@pytest.fixture
def here(tmp_path):
    """A shell in an empty folder."""
    return Space([], clean_environment(), f'cd "{tmp_path}";')


def put(folder, text):
    """Write a node, which may run."""
    (folder / 'my_node.py').write_bytes(text.encode())
    (folder / 'my_node.py').chmod(0o755)


def cure(here, command):
    """Run a command of the page on the node."""
    assert f'`{command}`' in DOC
    here.run(command)


@pytest.mark.parametrize('message', SAID)
def test_what_programs_for_python_2_say(here, tmp_path, message):
    put(tmp_path, SAID[message])
    says(message, fails(here, f'{PYTHON} my_node.py <<<2'))


def test_2to3_cures_print_and_raw_input(here, tmp_path):
    pytest.importorskip('lib2to3', reason='this Python has no lib2to3')
    put(tmp_path, OLD)
    assert '`2to3 -w -n my_node.py`' in DOC
    here.run(f'{PYTHON} -W ignore -m lib2to3 -w -n my_node.py')  # the command `2to3` is this
    assert here.run(f'{PYTHON} my_node.py <<<2') == 'speed: speed is 2\n'


def test_expand_cures_tabs(here, tmp_path):
    put(tmp_path, TABS)
    cure(here, 'expand -i -t 8 my_node.py >new.py')
    assert here.run(f'{PYTHON} new.py') == '1\n'


def test_sed_cures_lines_that_end_as_on_windows(here, tmp_path):
    put(tmp_path, '#!/usr/bin/env python3\r\nprint(1)\r\n')
    says(r"/usr/bin/env: 'python3\r': No such file or directory", fails(here, './my_node.py'))
    cure(here, r"sed -i 's/\r$//' my_node.py")
    assert here.run('./my_node.py') == '1\n'


def test_a_package_of_debian_that_is_not_installed_is_missing(here):
    # Without the modules of the system, in case it is installed.
    says("ModuleNotFoundError: No module named 'tf'", fails(here, f'{PYTHON} -I -S -c "import tf"'))


def test_off_without_quotes_is_a_truth_value(workspace):
    turtles = workspace.space('devel')
    pen = '{{r: 255, g: 0, b: 0, width: 3, {}: 1}}'
    with turtles.running('$LIB/turtlesim/turtlesim_node _gui:=false __ns:=/off'):
        call = 'rosservice call --wait /off/turtle1/set_pen'
        says('No field name [False]', fails(turtles, f'{call} "{pen.format("off")}"'))
        for right in (f'"{pen.format(repr("off"))}"', '255 0 0 3 1'):
            assert f'rosservice call /turtle1/set_pen {right}`' in ' '.join(DOC.split())
            assert turtles.run(f'{call} {right}').strip() == ''

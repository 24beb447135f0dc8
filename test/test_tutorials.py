"""Every lesson does what its page says, from nothing, in devel and in install space."""

import os
import pathlib
import re
import shutil
import xml.etree.ElementTree

import consoles
import pytest
from workspaces import ROOT, SPEED_GUARD, TUTORIALS, UNDERLAY, Space, clean_environment

FOLDER = ROOT / 'rumba_tutorials'
METAPACKAGE = FOLDER / 'rumba_tutorials'
PACKAGES = [path for path in TUTORIALS if path != METAPACKAGE]
LESSONS = sorted(path.parent for path in FOLDER.glob('[0-9]*/README.md'))
HEADINGS = ['Files', 'Run', 'What you see', 'What goes wrong', 'Why it works']
FROM_NOTHING = FOLDER / '01_own_message'  # its page makes a workspace, with which docs/building.md goes on
OF_LESSON = pytest.mark.parametrize('lesson', LESSONS, ids=lambda path: path.name)
OF_PACKAGE = pytest.mark.parametrize('package', PACKAGES, ids=lambda path: path.name)


@pytest.mark.thorough(except_for=['13_talker_and_listener'])
@pytest.mark.parametrize('lesson', [path for path in LESSONS if path != FROM_NOTHING], ids=lambda path: path.name)
def test_the_terminals_show_what_the_page_shows(workspace, lesson):
    if 'pip install' in (lesson / 'README.md').read_text() and not can_pip_install():
        pytest.skip('needs Python packages that ./rumba test could not fetch')
    # A master of its own: the first roslaunch, or roscore, starts it, as at the reader's.
    consoles.play(lesson / 'README.md', workspace.space('devel', clean_environment()))


def can_pip_install():
    """Whether pip may go to a package index, or finds packages that were fetched before."""
    return 'PIP_NO_INDEX' not in os.environ or pathlib.Path(os.environ.get('PIP_FIND_LINKS', 'nowhere')).exists()


@pytest.mark.thorough
def test_a_workspace_grows_from_nothing(tmp_path):
    # Without a workspace below it, as in an ordinary terminal; ~ is an empty folder.
    space = Space(UNDERLAY, {**clean_environment(), 'HOME': str(tmp_path)})
    consoles.play(FROM_NOTHING / 'README.md', space)
    if shutil.which('catkin'):  # a distribution may have no catkin-tools
        consoles.play(ROOT / 'docs' / 'building.md', space)


@pytest.mark.thorough
def test_a_library_and_its_header_serve_from_the_install_space(overlay):
    assert (overlay.path / 'build' / SPEED_GUARD.name).is_dir()
    consoles.play(SPEED_GUARD.parent / 'README.md', overlay.space('devel', clean_environment()))


@OF_LESSON
def test_the_page_has_its_parts_and_its_links_lead_somewhere(lesson):
    page = (lesson / 'README.md').read_text()
    text = re.sub('^```.*?^```$', '', page, flags=re.MULTILINE | re.DOTALL)
    assert re.findall('^## (.*)$', text, re.MULTILINE) == HEADINGS
    assert '**Goal.**' in page
    assert consoles.sessions(lesson / 'README.md')[-1][-1].lines != ['...'], 'nobody would wait for the last command'
    assert [link for link in re.findall(r'\]\(([^)#]+)', page) if not (lesson / link).exists()] == []


def test_the_table_of_lessons_and_the_metapackage_name_all():
    table = re.findall(r'^\| \[\d+\]\(([^)]+)/README.md\)', (FOLDER / 'README.md').read_text(), re.MULTILINE)
    assert table == [lesson.name for lesson in LESSONS]
    depends = xml.etree.ElementTree.parse(str(METAPACKAGE / 'package.xml')).iter('exec_depend')
    assert sorted(depend.text for depend in depends) == sorted(path.name for path in PACKAGES)


@OF_PACKAGE
def test_no_script_hides_its_package(package):
    # Python looks for `import PACKAGE` beside the script first.
    assert not (package / 'scripts' / f'{package.name}.py').exists()


@OF_PACKAGE
def test_all_that_is_there_to_run_is_installed(workspace, package):
    for place in ('lib', 'include'):
        built, installed = (names(workspace.path / space / place / package.name) for space in ('devel', 'install'))
        assert built - {pathlib.Path('cmake.lock')} <= installed
    share = workspace.path / 'install' / 'share' / package.name
    for folder in ('launch', 'config', 'msg', 'srv'):
        assert names(package / folder) <= names(share / folder)


@OF_PACKAGE
def test_cpp_is_compiled_after_the_headers_of_messages_are_written(workspace, package):
    wanted = {f'Built target {name}_generate_messages_cpp' for name in packages_of_messages(workspace, package)}
    for target in (workspace.path / 'build' / package.name).glob('CMakeFiles/*.dir/link.txt'):
        plan = workspace.space('devel').run(f'make -n -C {workspace.path}/build {target.parent.stem}')
        assert wanted <= set(re.findall(r'Built target \w+', plan)), target.parent.stem


def names(folder):
    """Files below a folder, relative to it; none if the folder does not exist."""
    return {path.relative_to(folder) for path in folder.rglob('*') if path.is_file()}


def packages_of_messages(workspace, package):
    """The packages, of those in the workspace, whose messages the C++ files of a package include."""
    sources = [path.read_text() for path in package.rglob('*') if path.suffix in ('.cpp', '.h')]
    headers = re.findall(r'^#include [<"]((\w+)/\w+\.h)[">]', '\n'.join(sources), re.MULTILINE)
    return {name for header, name in headers if (workspace.path / 'devel' / 'include' / header).exists()}

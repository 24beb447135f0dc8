"""Submissions as they come: what is taken of them, what is left out, and what is refused."""

import io
import os
import socket
import tarfile
import zipfile

import pytest

from rumba_evaluation.submissions import intake, scratch

MANIFEST = '<package format="3"><name>{}</name></package>'


@pytest.fixture
def source(tmp_path):
    """The folder of a package with one script."""
    folder = tmp_path / 'source' / 'cleaner'
    (folder / 'scripts').mkdir(parents=True)
    (folder / 'package.xml').write_text(MANIFEST.format('cleaner'))
    (folder / 'scripts' / 'clean').write_text('#!/usr/bin/env python3\n')
    return folder.parent


def taken(source, tmp_path):
    """Paths of what was taken, and the notes about the rest."""
    folder = tmp_path / 'taken'
    notes = intake.take(str(source), folder)
    return sorted(str(path.relative_to(folder)) for path in folder.rglob('*') if not path.is_dir()), notes


PACKAGE = ['cleaner/package.xml', 'cleaner/scripts/clean']


def test_a_folder_is_taken_without_what_tools_have_left_in_it(source, tmp_path):
    for name in ('.git', 'build', 'devel', '__pycache__', '__MACOSX'):
        (source / name).mkdir()
        (source / name / 'package.xml').write_text('')
    assert taken(source, tmp_path) == (PACKAGE, [])


def test_what_is_no_file_is_left_out_with_a_note(source, tmp_path):
    os.mkfifo(source / 'pipe')
    (source / 'memory').symlink_to('/proc/self/mem')
    (source / 'up').symlink_to('../..')
    (source / 'CMakeLists.txt').symlink_to('/usr/share/catkin/cmake/toplevel.cmake')
    with socket.socket(socket.AF_UNIX) as opened:
        opened.bind(os.path.relpath(str(source / 'socket')))
    found, notes = taken(source, tmp_path)
    assert found == PACKAGE
    assert sorted(notes) == ['memory is left out: it is a link to something outside',
                             'pipe is left out: it is neither a file nor a folder',
                             'socket is left out: it is neither a file nor a folder',
                             'up is left out: it is a link to something outside']


def test_links_inside_stay_and_no_chain_of_them_leads_out(source, tmp_path):
    (source / 'cleaner' / 'scripts' / 'other').symlink_to('clean')
    (source / 'deep' / 'er').mkdir(parents=True)
    (source / 'deep' / 'er' / 'link').symlink_to('../../cleaner')
    (source / 'deep' / 'er' / 'out').symlink_to('link/../../secret')
    found, notes = taken(source, tmp_path)
    assert 'cleaner/scripts/other' in found and 'deep/er/out' not in found
    assert notes == ['deep/er/out is left out: it is a link to something outside']


def test_names_may_hold_any_bytes(source, tmp_path):
    name = os.fsdecode(b'caf\xe9 \n.txt')
    (source / name).write_text('x')
    assert name in taken(source, tmp_path)[0] and len(intake.digest(str(source))) == 64


def archived(source, path, prefix=''):
    """An archive of a folder."""
    if path.suffix == '.zip':
        with zipfile.ZipFile(path, 'w') as archive:
            for name in PACKAGE:
                archive.write(source / name, prefix + name)
    else:
        with tarfile.open(path, 'w:gz' if path.suffix == '.gz' else 'w') as archive:
            archive.add(source / 'cleaner', prefix + 'cleaner')
    return path


@pytest.mark.parametrize('name', ['a.zip', 'a.tar', 'a.tar.gz', 'Zoë Ü.ZIP'])
def test_archives_are_unpacked_alone_or_in_a_folder_as_platforms_hand_them_out(source, tmp_path, name):
    path = tmp_path / name.lower()
    archived(source, path)
    path.rename(tmp_path / name)
    assert taken(tmp_path / name, tmp_path) == (PACKAGE, [])
    folder = tmp_path / 'platform'
    folder.mkdir()
    (tmp_path / name).rename(folder / name)
    assert [path.partition('_unpacked/')[2] for path in taken(folder, tmp_path / 'again')[0]] == PACKAGE


def test_an_archive_keeps_to_its_folder_and_names_of_windows_are_understood(tmp_path):
    path = tmp_path / 'a.zip'
    with zipfile.ZipFile(path, 'w') as archive:
        for name in ('../outside', '/absolute', 'cleaner\\package.xml', '__MACOSX/x'):
            archive.writestr(name, MANIFEST.format('cleaner'))
        link = zipfile.ZipInfo('link')
        link.external_attr = 0o120777 << 16
        archive.writestr(link, '/etc/passwd')
    found, notes = taken(path, tmp_path)
    assert found == ['cleaner/package.xml'] and not (tmp_path / 'outside').exists()
    assert notes == ['../outside is left out: it leads out of the archive',
                     '/absolute is left out: it leads out of the archive', 'link is left out: it is no file']


def test_links_and_devices_of_a_tar_file_are_left_out(tmp_path):
    path = tmp_path / 'a.tar'
    with tarfile.open(path, 'w') as archive:
        for name, kind in (('link', tarfile.SYMTYPE), ('hard', tarfile.LNKTYPE), ('zero', tarfile.CHRTYPE)):
            member = tarfile.TarInfo(name)
            member.type, member.linkname = kind, '/etc/passwd'
            archive.addfile(member)
        member = tarfile.TarInfo('package.xml')
        member.size = 1
        archive.addfile(member, io.BytesIO(b'x'))
    found, notes = taken(path, tmp_path)
    assert found == ['package.xml'] and len(notes) == 3


@pytest.mark.parametrize('content', [b'', b'PK\x03\x04 and no more', 1000 * b'x'])
@pytest.mark.parametrize('name', ['a.zip', 'a.tar', 'a.tgz'])
def test_a_damaged_archive_is_refused_with_its_name(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(intake.Refused, match=rf'^{name} cannot be unpacked: .'):
        intake.take(str(tmp_path / name), tmp_path / 'taken')


def test_an_archive_with_a_bit_that_has_changed_is_refused(tmp_path):
    path = tmp_path / 'a.zip'
    with zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED) as archive:
        archive.writestr('package.xml', 100 * MANIFEST)
    content = bytearray(path.read_bytes())
    content[45] ^= 0xff  # in what is compressed
    path.write_bytes(content)
    with pytest.raises(intake.Refused, match=r'^a.zip cannot be unpacked: .'):
        intake.take(str(path), tmp_path / 'taken')


def test_an_archive_with_a_password_is_refused(tmp_path):
    path = tmp_path / 'a.zip'
    with zipfile.ZipFile(path, 'w') as archive:
        archive.writestr('secret', 'x')
    content = bytearray(path.read_bytes())
    for mark, offset in ((b'PK\x03\x04', 6), (b'PK\x01\x02', 8)):
        content[content.index(mark) + offset] |= 1
    path.write_bytes(content)
    with pytest.raises(intake.Refused, match=r'^a.zip cannot be unpacked: .*(encrypted|password)'):
        intake.take(str(path), tmp_path / 'taken')


def test_what_is_too_large_is_refused_before_it_is_all_there(source, tmp_path, monkeypatch):
    path = tmp_path / 'a.zip'
    with zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED) as archive:
        archive.writestr('zeros', 10_000_000 * b'\0')
    monkeypatch.setattr(intake, 'MOST_BYTES', 3_000_000)
    with pytest.raises(intake.Refused, match=r'^the submission has more than 3 MB$'):
        intake.take(str(path), tmp_path / 'taken')
    assert (tmp_path / 'taken' / 'zeros').stat().st_size <= 3_000_000
    monkeypatch.setattr(intake, 'MOST_FILES', 1)
    with pytest.raises(intake.Refused, match=r'^the submission has more than 1 files$'):
        intake.take(str(source), tmp_path / 'again')


def test_folders_that_are_nested_too_deeply_are_refused(source, tmp_path):
    here = os.getcwd()
    os.chdir(source)
    for _ in range(2000):
        os.mkdir('deep')
        os.chdir('deep')
    os.chdir(here)
    for act in (lambda: intake.digest(str(source)), lambda: intake.take(str(source), tmp_path / 'taken')):
        with pytest.raises(intake.Refused, match='^the submission has folders in folders, more than 30 of them$'):
            act()
    scratch.remove(source / 'deep')  # pytest cannot


def test_the_packages_are_found_by_their_names_also_if_a_package_xml_is_damaged(tmp_path):
    for folder, text in ('a', MANIFEST.format('first')), ('b', '<package'), ('c', MANIFEST.format('$x')):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / 'package.xml').write_text(text)
    (tmp_path / 'd' / 'package.xml').mkdir(parents=True)
    assert [(name, path.name) for name, path in intake.packages(tmp_path)] == [('first', 'a'), ('b', 'b'), ('c', 'c')]


def test_a_single_script_becomes_the_node_that_is_wanted(tmp_path):
    (tmp_path / 'homework.py').write_text('#!/usr/bin/env python3\n')
    folder = tmp_path / 'taken'
    intake.take(str(tmp_path / 'homework.py'), folder)
    assert intake.as_package(folder, 'cleaner', 'clean')
    assert intake.packages(folder) == [('cleaner', folder / 'cleaner')]
    assert (folder / 'cleaner' / 'scripts' / 'clean').exists()
    assert not intake.as_package(folder, 'cleaner', 'clean')  # there are two files now


def test_the_digest_tells_names_and_contents_apart(source):
    found = [intake.digest(str(source))]
    (source / 'cleaner' / 'more').write_text('')
    found.append(intake.digest(str(source)))
    (source / 'cleaner' / 'more').write_text('x')
    found.append(intake.digest(str(source)))
    (source / 'cleaner' / 'more').rename(source / 'cleaner' / 'less')
    found.append(intake.digest(str(source)))
    assert len(set(found)) == 4
    (source / 'build').mkdir()
    (source / 'build' / 'log').write_text('x')
    assert intake.digest(str(source)) == found[-1]


def test_the_submissions_of_a_class_are_folders_archives_and_scripts(tmp_path):
    for name in ('folder', '.hidden', '__MACOSX'):
        (tmp_path / name).mkdir()
    for name in ('a.zip', 'b.tar.gz', 'c.py', 'list.csv', 'README'):
        (tmp_path / name).write_text('')
    (tmp_path / 'link').symlink_to('folder')
    with os.scandir(tmp_path) as entries:
        found = sorted(entry.name for entry in entries if intake.is_submission(entry))
    assert found == ['a.zip', 'b.tar.gz', 'c.py', 'folder']
    assert [intake.name_of(str(tmp_path / name)) for name in found] == ['a', 'b', 'c', 'folder']

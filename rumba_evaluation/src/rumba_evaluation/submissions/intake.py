"""Submissions as learning platforms hand them out: a script, a package, a workspace, or an archive of them.

Nothing in them is trusted: what is neither a file nor a folder, or leads out of the submission, is left out.
"""

import contextlib
import hashlib
import lzma
import os
import pathlib
import re
import shutil
import stat
import tarfile
import zipfile
import zlib
from typing import IO, Iterator, List, Tuple
from xml.etree import ElementTree

ARCHIVES = ('.zip', '.tar', '.tar.gz', '.tgz', '.tar.bz2', '.tar.xz')
SCRIPTS = ('.py', '')  # endings of a submission that is one script
LEFT_OUT = frozenset(('.git', '.svn', '__pycache__', '__MACOSX', 'build', 'devel', 'install', '.catkin_tools',
                      '.catkin_workspace', '.DS_Store', '.venv'))
MOST_FILES, MOST_BYTES, MOST_DEPTH = 5_000, 200_000_000, 30
NESTED = 2  # archives in archives
# What zipfile and tarfile raise if an archive is damaged, has a password, or is compressed in an unknown way.
DAMAGED = (zipfile.BadZipFile, tarfile.TarError, zlib.error, lzma.LZMAError, EOFError, RuntimeError, ValueError)
MANIFEST = 'package.xml'
# What a script may use that comes without a package.
USUAL = ('rospy', 'actionlib', 'geometry_msgs', 'nav_msgs', 'rumba_msg', 'sensor_msgs', 'std_msgs', 'std_srvs',
         'tf2_ros', 'turtlesim')


class Refused(Exception):
    """A submission cannot be taken, in words."""


def is_submission(entry: 'os.DirEntry[str]') -> bool:
    """Whether an entry of the folder of a class is a submission: a folder, an archive or a script in Python."""
    if entry.name.startswith('.') or entry.name in LEFT_OUT or entry.is_symlink():
        return False
    return entry.is_dir() or entry.is_file() and (entry.name.lower().endswith(ARCHIVES) or entry.name.endswith('.py'))


def name_of(path: str) -> str:
    """The name of a submission: that of its folder, or of its file without the ending."""
    name = os.path.basename(os.path.abspath(path))
    ending = next((each for each in (*ARCHIVES, '.py') if name.lower().endswith(each)), '')
    return name[:len(name) - len(ending)] if ending and not os.path.isdir(path) else name


def take(source: str, folder: pathlib.Path) -> List[str]:
    """Copy a submission into a folder that does not exist yet, and unpack what is an archive.

    Returns what was left out, in words.

    Raises:
        Refused: it is too large, or an archive is damaged.
        OSError: it cannot be read, or not be written.
    """
    return _Copy(folder).take(source)


def packages(folder: pathlib.Path) -> List[Tuple[str, pathlib.Path]]:
    """Names and folders of the packages in a submission; the name is that of the folder if package.xml has none."""
    found = []
    for path in sorted(folder.rglob(MANIFEST)):
        if path.is_file():
            try:
                name = (ElementTree.parse(str(path)).getroot().findtext('name') or '').strip()
            except (ElementTree.ParseError, ValueError, LookupError):  # of what is no XML, or of an unknown encoding
                name = ''
            found.append((name if re.fullmatch(r'[\w-]+', name) else path.parent.name, path.parent))
    return found


def digest(source: str) -> str:
    """Identifies a submission by the names and the contents of its files."""
    found = hashlib.sha256()
    for path in [source] if os.path.isfile(source) else _files(source):
        try:
            found.update(os.fsencode(os.path.relpath(path, source)) + b'\0' + _hash(path))
        except OSError as error:
            found.update(str(error.errno).encode())
    return found.hexdigest()


def _files(folder: str) -> Iterator[str]:
    """The paths of what is in a folder, without what is left out.

    Raises:
        Refused: it has too many folders in folders.
    """
    waiting = [(folder, 0)]
    while waiting:
        place, depth = waiting.pop()
        if depth > MOST_DEPTH:
            raise Refused(f'the submission has folders in folders, more than {MOST_DEPTH} of them')
        with contextlib.suppress(PermissionError), os.scandir(place) as entries:
            for entry in sorted(entries, key=lambda entry: entry.name, reverse=True):
                if not entry.is_dir(follow_symlinks=False):
                    yield entry.path
                elif entry.name not in LEFT_OUT:
                    waiting.append((entry.path, depth + 1))


def _hash(path: str) -> bytes:
    found = hashlib.sha256(str(os.readlink(path) if os.path.islink(path) else '').encode(errors='surrogateescape'))
    if stat.S_ISREG(os.lstat(path).st_mode):
        with open(path, 'rb') as file:
            for part in iter(lambda: file.read(1 << 20), b''):
                found.update(part)
    return found.digest()


class _Copy:
    """A copy that is being made."""

    def __init__(self, folder: pathlib.Path) -> None:
        self._folder = folder
        self._notes: List[str] = []
        self._files = self._bytes = 0

    def take(self, source: str) -> List[str]:
        """Copy everything; returns what was left out."""
        self._folder.mkdir(parents=True)
        if os.path.isdir(source):
            self._take_folder(source)
        elif source.lower().endswith(ARCHIVES):
            self._unpack(source, self._folder)
        else:
            self._take_file(source, os.path.basename(source))
        self._drop_links()
        for _ in range(NESTED):
            self._unpack_archives()
        return self._notes

    def _take_folder(self, source: str) -> None:
        for path in _files(source):
            self._take_file(path, os.path.relpath(path, source))

    def _take_file(self, path: str, name: str) -> None:
        kind = os.lstat(path).st_mode
        target = self._folder / name
        if stat.S_ISLNK(kind):
            self._take_link(path, name)
        elif not stat.S_ISREG(kind):
            self._leave_out(name, 'is neither a file nor a folder')
        else:
            try:
                with open(path, 'rb') as file:
                    self._write(file, target, kind)
            except PermissionError:
                self._leave_out(name, 'cannot be read')

    def _take_link(self, path: str, name: str) -> None:
        self._count(files=1)
        target = self._folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.symlink_to(os.readlink(path))

    def _drop_links(self) -> None:
        """Keep those links that stay in the submission: they may stand for a script."""
        own = str(self._folder.resolve())
        for path in list(self._folder.rglob('*')):
            if path.is_symlink() and not f'{os.path.realpath(str(path))}/'.startswith(f'{own}/'):
                path.unlink()
                if path.name != 'CMakeLists.txt':  # of a workspace: catkin makes it again
                    self._leave_out(str(path.relative_to(self._folder)), 'is a link to something outside')

    def _write(self, file: IO[bytes], target: pathlib.Path, mode: int) -> None:
        self._count(files=1)
        if len(target.relative_to(self._folder).parts) > MOST_DEPTH:
            raise Refused(f'an archive has folders in folders, more than {MOST_DEPTH} of them')
        target.parent.mkdir(parents=True, exist_ok=True)
        with open(target, 'wb') as copy:
            for part in iter(lambda: file.read(1 << 20), b''):
                self._count(size=len(part))
                copy.write(part)
        target.chmod(0o755 if mode & 0o111 else 0o644)

    def _count(self, files: int = 0, size: int = 0) -> None:
        self._files += files
        self._bytes += size
        if self._files > MOST_FILES:
            raise Refused(f'the submission has more than {MOST_FILES} files')
        if self._bytes > MOST_BYTES:
            raise Refused(f'the submission has more than {MOST_BYTES // 1_000_000} MB')

    def _leave_out(self, name: str, why: str) -> None:
        self._notes.append(f'{name} is left out: it {why}')

    # --- archives -----------------------------------------------------------------------------------------------------

    def _unpack_archives(self) -> None:
        """Unpack archives of a submission that has no package: some platforms put what was handed in into a folder."""
        if packages(self._folder):
            return
        for path in sorted(self._folder.rglob('*')):
            if path.name.lower().endswith(ARCHIVES) and path.is_file() and not path.is_symlink():
                self._unpack(str(path), path.with_name(path.name + '_unpacked'))
                path.unlink()

    def _unpack(self, path: str, folder: pathlib.Path) -> None:
        try:
            if path.lower().endswith('.zip'):
                self._unpack_zip(path, folder)
            else:
                self._unpack_tar(path, folder)
        except DAMAGED as error:
            raise Refused(f'{os.path.basename(path)} cannot be unpacked: {error}') from error

    def _unpack_zip(self, path: str, folder: pathlib.Path) -> None:
        with zipfile.ZipFile(path) as archive:
            for member in archive.infolist():
                mode = member.external_attr >> 16
                if member.is_dir():
                    continue
                if stat.S_IFMT(mode) not in (0, stat.S_IFREG):
                    self._leave_out(member.filename, 'is no file')
                elif self._is_harmless(member.filename):
                    with archive.open(member) as file:
                        self._write(file, folder / member.filename.replace('\\', '/'), mode)

    def _unpack_tar(self, path: str, folder: pathlib.Path) -> None:
        with tarfile.open(path) as archive:
            for member in archive:
                if member.isdir():
                    continue
                if not member.isfile():
                    self._leave_out(member.name, 'is no file')
                elif self._is_harmless(member.name):
                    file = archive.extractfile(member)
                    assert file is not None  # it is a file
                    self._write(file, folder / member.name, member.mode)

    def _is_harmless(self, name: str) -> bool:
        """Whether a member of an archive stays in its folder; what is never needed is left out in silence."""
        parts = pathlib.PurePosixPath(name.replace('\\', '/')).parts
        if name.startswith('/') or '..' in parts or not parts:
            self._leave_out(name, 'leads out of the archive')
            return False
        return not LEFT_OUT.intersection(parts)


def as_package(folder: pathlib.Path, package: str, script: str) -> bool:
    """Make the only script of a submission the script of a package; returns whether it has only one file."""
    files = [path for path in folder.rglob('*') if path.is_file()]
    if len(files) != 1 or files[0].suffix not in SCRIPTS:
        return False
    place = folder / package / 'scripts'
    place.mkdir(parents=True)
    shutil.move(str(files[0]), str(place / script))
    needs = ''.join(f'<exec_depend>{each}</exec_depend>' for each in USUAL)
    (folder / package / MANIFEST).write_text(f'<package format="3"><name>{package}</name>{needs}</package>\n')
    return True

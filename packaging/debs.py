"""Makes Debian packages of the catkin packages in a workspace that was built for /usr: what `./rumba deb` does last.

    SOURCE_DATE_EPOCH=SECONDS python3 packaging/debs.py WORKSPACE FOLDER

Each package in WORKSPACE/src becomes FOLDER/ros-NAME_VERSION_all.deb; those of other versions in FOLDER are deleted.
The same sources and the same SOURCE_DATE_EPOCH, which is the date of all files, give the same bytes.
"""

import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import textwrap

from catkin_pkg.package import Package
from catkin_pkg.packages import find_packages
from debian_names import DebianNames, debian_name

LICENSE = pathlib.Path(__file__).resolve().parents[1] / 'LICENSE'
MODULES = 'usr/lib/python3/dist-packages'
POSTINST = '#!/bin/sh\nset -e\n[ "$1" != configure ] || py3compile -p {name}\n'
# With the bytecode goes what numba compiled for root, which no package owns.
PRERM = '#!/bin/sh\nset -e\n[ ! -d {modules} ] || find {modules} -depth -name __pycache__ -exec rm -r {{}} +\n'


def stage(package: Package, built: pathlib.Path, root: pathlib.Path) -> None:
    """Install a package that was built in a folder below `root`, without bytecode, which belongs to one Python."""
    subprocess.run(['cmake', '-P', str(built / 'cmake_install.cmake')], check=True, stdout=subprocess.PIPE,
                   stderr=subprocess.STDOUT, env={**os.environ, 'DESTDIR': str(root), 'PYTHONDONTWRITEBYTECODE': '1'})
    for cache in list(root.glob('**/__pycache__')):
        shutil.rmtree(str(cache))
    copyright_file = root / 'usr' / 'share' / 'doc' / debian_name(package.name) / 'copyright'
    copyright_file.parent.mkdir(parents=True)
    copyright_file.write_text(f'{package.name} is part of Rumba. Licence: {", ".join(package.licenses)}\n\n'
                              f'{LICENSE.read_text()}')


def control(package: Package, names: DebianNames, size: int) -> str:
    """The file that tells dpkg about a package of `size` [KiB]."""
    maintainer = package.maintainers[0]
    relations = names.relations(package)
    lines = [f'Package: {debian_name(package.name)}', f'Version: {package.version}', 'Architecture: all',
             f'Maintainer: {maintainer.name} <{maintainer.email}>', f'Installed-Size: {size}', 'Section: misc',
             'Priority: optional', *(f'{field}: {", ".join(needed)}' for field, needed in relations.items()),
             f'Description: {package.name} of Rumba, a Roomba for ROS 1',
             *(f' {line}' for line in textwrap.wrap(package.description, 78))]
    return '\n'.join(lines) + '\n'


def add_control(package: Package, names: DebianNames, root: pathlib.Path) -> None:
    """Add to what was installed below `root` the files that dpkg reads."""
    files = sorted(path for path in root.glob('**/*') if path.is_file())
    debian = root / 'DEBIAN'
    debian.mkdir()
    size = sum(path.stat().st_size for path in files) // 1024 + 1
    (debian / 'control').write_text(control(package, names, size))
    (debian / 'md5sums').write_text(''.join(
        f'{hashlib.md5(path.read_bytes()).hexdigest()}  {path.relative_to(root)}\n' for path in files))
    if (root / MODULES / package.name).is_dir():
        scripts = {'postinst': POSTINST.format(name=debian_name(package.name)),
                   'prerm': PRERM.format(modules=f'/{MODULES}/{package.name}')}
        for name, script in scripts.items():
            (debian / name).write_text(script)
            (debian / name).chmod(0o755)


def settle(root: pathlib.Path, date: int) -> None:
    """Give all below `root` ordinary permissions and a date [s since 1970], whatever umask and file system made."""
    for path in [root, *root.glob('**/*')]:
        path.chmod(0o755 if path.is_dir() or path.stat().st_mode & 0o100 else 0o644)
        os.utime(str(path), (date, date))


def main(workspace: pathlib.Path, folder: pathlib.Path) -> None:
    """Make the packages, and print their paths."""
    packages = find_packages(str(workspace / 'src'))
    names = DebianNames({package.name: package.version for package in packages.values()})
    for path, package in sorted(packages.items()):
        name = debian_name(package.name)
        with tempfile.TemporaryDirectory() as temporary:
            root = pathlib.Path(temporary) / name
            stage(package, workspace / 'build' / path, root)
            add_control(package, names, root)
            settle(root, int(os.environ['SOURCE_DATE_EPOCH']))
            for old in folder.glob(f'{name}_*_all.deb'):
                old.unlink()
            deb = folder / f'{name}_{package.version}_all.deb'
            # More threads would cut the data otherwise on other machines.
            subprocess.run(['dpkg-deb', '--root-owner-group', '-Zxz', '--build', str(root), str(deb)], check=True,
                           stdout=subprocess.DEVNULL, env={**os.environ, 'DPKG_DEB_THREADS_MAX': '1'})
        print(deb)


if __name__ == '__main__':
    try:
        main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
    except (OSError, ValueError) as exc:
        sys.exit(f'rumba: {exc}')
    except subprocess.CalledProcessError as exc:
        sys.exit(f'rumba: {exc}\n{(exc.stdout or b"").decode(errors="replace")}')

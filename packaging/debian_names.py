"""What Debian calls the dependencies of our packages: packages.txt says it, and rosdep_keys.yaml what is not of ROS."""

import pathlib
from typing import Dict, List, Set

import yaml
from catkin_pkg.package import Package

FOLDER = pathlib.Path(__file__).resolve().parent


def debian_name(package: str) -> str:
    """What Debian would call a package of ROS."""
    return 'ros-' + package.replace('_', '-')


class DebianNames:
    """The Debian packages that packages need which are built together."""

    def __init__(self, versions: Dict[str, str]) -> None:
        """`versions` are those of the packages that are built together, by name."""
        self._versions = versions
        lines = (FOLDER.parent / 'packages.txt').read_text().splitlines()
        self._lines = [line.split() for line in lines if line and not line.startswith('#')]
        keys = yaml.safe_load((FOLDER / 'rosdep_keys.yaml').read_text())
        self._keys: Dict[str, str] = {**keys['read'], **keys['assumed']}

    def relations(self, package: Package) -> Dict[str, List[str]]:
        """What a package needs (Depends), is of more use with (Recommends) and can do without (Suggests).

        Raises:
            ValueError: nothing says what Debian calls one of its dependencies.
        """
        exported = {depend.name for depend in package.build_export_depends}
        keys = exported | {depend.name for depend in package.exec_depends}
        optional = {key for key in keys if any(role == 'optional' for role, _, _ in self._of_ros(key))}
        try:
            depends = {name for key in keys - optional for name in self._needed(key, key in exported)}
        except KeyError as exc:
            raise ValueError(f'{package.filename}: no Debian package is known for {exc.args[0]}: add it to '
                             'packages.txt if it belongs to ROS, else to packaging/rosdep_keys.yaml') from exc
        role = package.name.partition('_')[2]
        recommended = {name for named, name, _ in self._lines if named == role}
        suggested = {name for key in optional for _, name, _ in self._of_ros(key)} - {'-'}
        # python3 brings py3compile.
        found = {'Depends': depends | {'python3'}, 'Recommends': recommended - depends, 'Suggests': suggested}
        return {field: sorted(names) for field, names in found.items() if names}

    def _needed(self, key: str, with_headers: bool) -> Set[str]:
        """Names for a key of a package.xml; for one of messages its modules too and, `with_headers`, its headers."""
        if key in self._versions:
            return {f'{debian_name(key)} (= {self._versions[key]})'}
        if key in self._keys:
            return {self._keys[key]}
        if not self._of_ros(key):
            raise KeyError(key)
        dashed = key.replace('_', '-')
        parts = {f'python3-{dashed}'} | ({f'lib{dashed}-dev'} if with_headers else set())
        return {name for _, name, _ in self._of_ros(key)} | {
            name for _, name, of_ros in self._lines if of_ros == '-' and name in parts}

    def _of_ros(self, key: str) -> List[List[str]]:
        return [line for line in self._lines if line[2] == key]

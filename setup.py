"""What pyproject.toml cannot say: the version, which stands in package.xml, and which folders become which modules."""

import pathlib
import xml.etree.ElementTree as ElementTree

from setuptools import find_packages, setup

ROOT = pathlib.Path(__file__).resolve().parent
PACKAGES = ('rumba_sim', 'rumba_localisation', 'rumba_cleaning', 'rumba_evaluation')
NEEDS_ROS = ('*.ros', '*.ros.*')
MAPS = 'rumba_sim.maps'  # where rumba_sim.model.named_maps finds them

setup(
    version=ElementTree.parse(str(ROOT / 'rumba_evaluation' / 'package.xml')).findtext('version'),
    packages=[MAPS] + [name for package in PACKAGES for name in find_packages(f'{package}/src', exclude=NEEDS_ROS)],
    package_dir={MAPS: 'rumba_sim/maps', **{package: f'{package}/src/{package}' for package in PACKAGES}},
    package_data={MAPS: ['*.png', '*.yaml']},
)

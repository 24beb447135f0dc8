"""What pyproject.toml cannot say: licence and version, as in package.xml, and which folders become which modules."""

import pathlib
import xml.etree.ElementTree as ElementTree

from setuptools import __version__, find_packages, setup

ROOT = pathlib.Path(__file__).resolve().parent
PACKAGES = ('rumba_sim', 'rumba_localisation', 'rumba_cleaning', 'rumba_evaluation')
NEEDS_ROS = ('*.ros', '*.ros.*')
PUBLIC = 'rumba'  # what users import
MAPS = 'rumba_sim.maps'  # where rumba_sim.model.maps.named_maps finds them
PACKAGE = ElementTree.parse(str(ROOT / 'rumba_evaluation' / 'package.xml'))
# It is an SPDX identifier, for which setuptools has a field of its own since 77, which needs Python 3.9.
LICENSE_FIELD = 'license_expression' if int(__version__.split('.')[0]) >= 77 else 'license'

setup(
    version=PACKAGE.findtext('version'),
    **{LICENSE_FIELD: PACKAGE.findtext('license')},
    packages=[MAPS] + [name for package in PACKAGES for name in find_packages(f'{package}/src', exclude=NEEDS_ROS)],
    package_dir={MAPS: 'rumba_sim/maps', PUBLIC: f'rumba_evaluation/src/{PUBLIC}',
                 **{package: f'{package}/src/{package}' for package in PACKAGES}},
    package_data={MAPS: ['*.png', '*.yaml'], **{package: ['py.typed'] for package in (PUBLIC, *PACKAGES)}},
)

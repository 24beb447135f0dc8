"""Where catkin finds the Python package."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=['zigzag_strategy'], package_dir={'': 'src'}))

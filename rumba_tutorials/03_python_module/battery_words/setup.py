"""Only for catkin_python_setup(); never call it by hand."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=['battery_words'], package_dir={'': 'src'}))

"""How long rumba_msg takes to build from nothing, with the generators that ./rumba uses and with all generators."""

import os
import pathlib
import statistics
import subprocess
import tempfile
import time

PACKAGE = pathlib.Path(__file__).resolve().parents[1] / 'rumba_msg'
HEADER = 'devel/include/rumba_msg/BatteryStatus.h'
RUNS = 3


def seconds_to_build(environment):
    """Wall-clock seconds of one `catkin_make` in a new workspace that holds only rumba_msg."""
    with tempfile.TemporaryDirectory() as workspace:
        source = pathlib.Path(workspace, 'src')
        source.mkdir()
        (source / PACKAGE.name).symlink_to(PACKAGE)
        begin = time.monotonic()
        subprocess.run(['catkin_make', '-C', workspace, f'-j{os.cpu_count()}', '-DPYTHON_EXECUTABLE=/usr/bin/python3',
                        '-DPython_EXECUTABLE=/usr/bin/python3'], env=environment, stdout=subprocess.DEVNULL, check=True)
        assert pathlib.Path(workspace, HEADER).exists()
        return time.monotonic() - begin


def main():
    """Measure and print."""
    few = {name: value for name, value in os.environ.items() if name != 'CMAKE_PREFIX_PATH'}
    everything = {name: value for name, value in few.items() if name != 'ROS_LANG_DISABLE'}
    print(f'rumba_msg from nothing, {os.cpu_count()} cores, median of {RUNS}')
    for title, environment in ((f'without {few["ROS_LANG_DISABLE"]}', few), ('with every generator', everything)):
        median = statistics.median(seconds_to_build(environment) for _ in range(RUNS))
        print(f'  {title:<40} {median:5.1f} s')


if __name__ == '__main__':
    main()

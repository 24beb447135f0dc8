"""Homework that is right but for a mistake of beginners."""

import shutil

from common.good_homework import CPP_BUMPER, bumper_by_two_nodes_and_a_message
from common.homework import BUMPER, MAKERS, STATUS, WRONG, cmake, in_cpp, package, replace, script, solved


def wrong(exercise):
    """Register what is right but for a mistake."""
    def register(maker):
        def make(path):
            solved(path, exercise)
            maker(path)
        make.__name__ = maker.__name__
        MAKERS[WRONG].append((exercise, make))
        return maker
    return register


@wrong(STATUS)
def windows_line_ends(path):
    script(path).write_bytes(script(path).read_bytes().replace(b'\n', b'\r\n'))


@wrong(STATUS)
def byte_order_mark(path):
    script(path).write_bytes(b'\xef\xbb\xbf' + script(path).read_bytes())


@wrong(STATUS)
def script_with_another_name(path):
    script(path).rename(script(path).with_name('status_node.py'))


@wrong(STATUS)
def script_that_is_missing(path):
    script(path).unlink()


@wrong(STATUS)
def without_first_line(path):
    script(path).write_text(script(path).read_text().partition('\n')[2])


@wrong(STATUS)
def python_2(path):
    replace(path, 'Status()\nrospy.spin', "Status()\nprint 'ready'\nrospy.spin")


@wrong(STATUS)
def tabs_and_spaces(path):
    replace(path, '        status = BatteryStatus()', '\tstatus = BatteryStatus()')


@wrong(STATUS)
def share_for_percent(path):
    replace(path, 'math.ceil(100.0 * battery.percentage)', 'int(battery.percentage)')


@wrong(STATUS)
def wrong_topic(path):
    replace(path, 'student/battery_status', 'battery_status')


@wrong(STATUS)
def wrong_type(path):
    replace(path, "'student/battery_status', BatteryStatus", "'student/battery_status', BatteryState")
    replace(path, 'status = BatteryStatus()', 'status = BatteryState()')
    replace(path, 'status.percentage_battery', 'status.percentage')
    for name in ('location_x', 'location_y', 'orientation_theta'):
        replace(path, f'status.{name}', 'status.charge')
    replace(path, 'status.debug_message', 'status.location')


@wrong(STATUS)
def ends_at_once(path):
    replace(path, '\nrospy.spin()\n', '\n')


@wrong(STATUS)
def endless_loop(path):
    replace(path, '\nrospy.spin()\n', '\nwhile True: pass\n')
    replace(path, "\n        rospy.Subscriber('rumba/battery_state'", "\n        0, ('rumba/battery_state'")


@wrong(STATUS)
def misspelt_module(path):
    replace(path, 'import rospy\n', 'import rospy\nimport numpyy\n')


@wrong(BUMPER)
def package_that_is_not_installed(path):
    cmake(package(path), 'geometry_msgs moveit_core rospy', rest='add_library(nothing nothing.cpp)')


@wrong(BUMPER)
def error_in_cpp(path):
    in_cpp(path, CPP_BUMPER.replace('--backing, twist', '--backing twist'), 'cleaner',
           'geometry_msgs roscpp rumba_msg')


@wrong(BUMPER)
def not_linked(path):
    in_cpp(path, CPP_BUMPER, 'cleaner', 'geometry_msgs roscpp rumba_msg')
    text = (package(path) / 'CMakeLists.txt').read_text()
    (package(path) / 'CMakeLists.txt').write_text(text[:text.index('target_link')])


@wrong(BUMPER)
def message_that_is_not_listed(path):
    bumper_by_two_nodes_and_a_message(path)
    lists = package(path) / 'CMakeLists.txt'
    lists.write_text(lists.read_text().replace('add_message_files(FILES Hit.msg)\ngenerate_messages()',
                                               'add_library(nothing src/nothing.cpp)'))
    (package(path) / 'src').mkdir()
    (package(path) / 'src' / 'nothing.cpp').write_text('')


@wrong(BUMPER)
def nothing_handed_in(path):
    shutil.rmtree(package(path))


@wrong(BUMPER)
def only_scripts(path):
    (package(path) / 'package.xml').unlink()


@wrong(BUMPER)
def ignores_its_bumper(path):
    replace(path, '= 3, 18', '= 0, 0')

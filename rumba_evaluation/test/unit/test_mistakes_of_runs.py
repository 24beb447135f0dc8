"""What went wrong in the nodes of a submission during a test, by what they, roslaunch and rostest printed."""

import time

import pytest
from printed import sections

from rumba_evaluation.submissions.diagnosis.mistakes import MOST, of_run

PRINTED = sections('printed_by_runs.txt')
SCRIPTS = 'sweeper/scripts/'


@pytest.mark.parametrize('name, begin, advice', [
    ('backtick2', 'backtick2, line 3: SyntaxError (invalid syntax) in `a = `3``: this is Python 2', 'Python 3'),
    ('callback', "callback, line 6: AttributeError ('String' object has no attribute 'date') in `return message.date`",
     'rosmsg show'),
    ('caused', 'caused, line 7: ValueError (noa) in `raise ValueError(', 'the node ends here'),
    ('chained', 'chained, line 7: IndexError (list index out of range)', 'the node ends here'),
    ('clean', 'clean ended before the test was over, without an error', 'rospy.spin()'),
    ('encoding', 'encoding, line 3: SyntaxError (Non-UTF-8', 'save the file as UTF-8'),
    ('except2', 'except2, line 5: SyntaxError (', 'this is Python 2'),
    ('exit3', 'exit3 ended before the test was over, with the exit code 3', 'sys.exit()'),
    ('indent', 'indent, line 4: IndentationError (expected an indented block', 'the same number of spaces'),
    ('iteritems2', 'iteritems2, line 4: AttributeError (', 'iteritems is Python 2: write items instead'),
    ('kill', 'kill was stopped by a segmentation fault', 'index'),
    ('no_init', 'no_init, line 5: ROSException (ROS node has not been initialized', "call rospy.init_node('NAME')"),
    ('no_message', "no_message, line 3: ImportError (cannot import name 'Bumpers' from 'rumba_msg.msg') in ",
     '`rosmsg package rumba_msg`'),
    ('no_module', "no_module, line 3: ModuleNotFoundError (No module named 'rumba_msgs')",
     'messages of rumba_msgs are not installed'),
    ('no_python', 'no_python: the program in its first line does not exist here', '#!/usr/bin/env python3'),
    ('no_rospy', "no_rospy, line 2: NameError (name 'rospy' is not defined)", 'write import rospy at the top'),
    ('octal2', 'octal2, line 3: SyntaxError (', 'this is Python 2'),
    ('own_module', "own_module, line 3: ModuleNotFoundError (No module named 'helpers')", 'put it beside this one'),
    ('paren', "paren, line 3: SyntaxError ('(' was never closed)", 'brackets'),
    ('print2', "print2, line 4: SyntaxError (Missing parentheses in call to 'print'", 'this is Python 2'),
    ('recursion', 'recursion, line 5: RecursionError (maximum recursion depth exceeded)', 'the node ends here'),
    ('syntax', "syntax, line 3: SyntaxError (expected ':')", 'brackets, quotation marks and :'),
    ('tabs', 'tabs, line 5: TabError (inconsistent use of tabs', 'replace each tab by four spaces'),
    ('thread', 'thread, line 5: IndexError (list index out of range)', 'which value'),
    ('timer', "timer, line 4: NameError (name 'nothing' is not defined)", 'spelling'),
    ('urllib2', 'urllib2, line 3: ModuleNotFoundError (', 'write import urllib.request instead'),
    ('wrong_field', 'wrong_field, line 8: ROSSerializationException (field data must be float type)', 'another type'),
    ('xrange2', 'xrange2, line 4: NameError (', 'xrange is Python 2: write range instead'),
    ('zero', 'zero, line 5: ZeroDivisionError (division by zero) in `return 1 / 0`', 'print()')])
def test_a_script_that_fails_has_one_reason_with_its_place_and_what_to_do(name, begin, advice):
    [told] = of_run(PRINTED[name])
    assert told.startswith(SCRIPTS + begin) and advice in told


@pytest.mark.parametrize('name, begin, advice', [
    ('cpp_crash', 'roller/crash was stopped by a segmentation fault', 'index'),
    ('cpp_ends', 'roller/ends ended before the test was over, without an error', 'ros::spin()'),
    ('cpp_no_init', 'roller/no_init: call ros::init(argc, argv, "NAME")', 'NodeHandle'),
    ('cpp_py', 'roller/scripts/py, line 4: IndexError (list index out of range)', 'the node ends here'),
    ('cpp_throws', 'roller/throws ended with the exception std::out_of_range (vector::_M_range_check', 'the line'),
    ('crlf', 'a script has Windows line ends (CR LF)', 'Unix line ends (LF)'),
    ('no_shebang', 'a script cannot start', '#!/usr/bin/env python3'),
    ('no_such_package', 'the node zero cannot start: there is no package sweper', ''),
    ('no_such_type', 'the node cleener cannot start: the package sweeper has no node cleener', 'exactly this name')])
def test_a_node_that_does_not_start_or_was_built_has_a_reason_too(name, begin, advice):
    [told] = of_run(PRINTED[name])
    assert told.startswith(begin) and advice in told


def test_a_service_that_fails_is_told_before_its_client():
    first, second = of_run(PRINTED['service'])
    assert first.startswith(f'{SCRIPTS}service, line 5: TypeError (unsupported operand type(s) for +:')
    assert 'each time it is called' in first and second.startswith(f'{SCRIPTS}service, line 6: ServiceException')


def test_what_nodes_print_when_the_test_is_over_is_no_reason():
    assert of_run(PRINTED['no_init_wait']) == []
    over = PRINTED['chained'].replace("KeyError: 'a'", 'rospy.exceptions.ROSInterruptException: rospy shutdown')
    assert of_run(over) == of_run(PRINTED['chained'].replace('IndexError: list index out of range',
                                                             'KeyboardInterrupt')) == []


@pytest.mark.parametrize('name', ['chained', 'zero', 'callback', 'print2', 'encoding', 'clean', 'exit3', 'cpp_crash'])
def test_what_happens_to_nodes_of_others_is_no_reason(name):
    assert of_run(PRINTED[name].replace('/tmp/mark/src/submission', '/tmp/mark/src/others')) == []


def test_the_same_exception_is_told_once_and_others_beside_it():
    told = of_run(PRINTED['callback'] * 100 + PRINTED['zero'] + PRINTED['zero'])
    assert [each.split(':')[0] for each in told] == [f'{SCRIPTS}callback, line 6', f'{SCRIPTS}zero, line 5']


def test_a_test_without_mistakes_has_no_reasons():
    assert of_run('') == of_run('[ROSTEST]---\n\n[student][passed]\n') == []


def test_nothing_that_a_terminal_obeys_is_quoted():
    printed = PRINTED['zero'].replace('return', '\x9b').replace(
        'division by zero', 'a\r\x1b[2J\x07\u202eb' + 300 * 'c')
    [told] = of_run(printed)
    assert told.isprintable() and 'a\\r\\x1b[2J\\x07\\u202eb' in told and 200 * 'c' not in told


@pytest.mark.parametrize('piece', [
    'Traceback (most recent call last):\n', '  File "', '  File "/src/submission/a", line 1\n', ' \n', 'SyntaxError: ',
    '/src/submission/', "['Traceback (most recent call last):\\n', '",
    '] process has died [pid 1, exit code -11, cmd /',
    '/usr/bin/env: ', 'cannot launch node of type [', '\033[0;', 'During handling of the above exception\n', 'print ',
    '  File "/src/submission/a", line 1\n    print 0 <> 00', '\r'])
def test_a_megabyte_of_anything_is_read_within_seconds(piece):
    began = time.process_time()
    for end in ('', "\nSyntaxError: name 'a'\n"):
        assert len(of_run(piece * (1_000_000 // len(piece)) + end)) <= MOST
    assert time.process_time() - began < 10.0

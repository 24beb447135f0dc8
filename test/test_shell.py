"""What ./rumba shell offers at its prompt."""

import subprocess

from checkouts import make_checkout, surroundings

# Calls what the tab key would call, on a command line that was typed.
TAB = r'''
tab() { COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMP_LINE=$*; COMP_POINT=${#COMP_LINE}; _roscomplete_rostopic; }
'''


def typed(checkout, commands, tmp_path):
    """What the shell of a checkout prints while commands are typed."""
    done = subprocess.run([str(checkout / 'rumba'), 'shell'], input=f'{TAB}{commands}\nexit 3\n', timeout=300.0,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                          env=surroundings(XDG_CACHE_HOME=str(tmp_path / 'cache'), HOME=str(tmp_path)))
    assert done.returncode == 3, done.stdout
    return done.stdout


def test_roscd_leads_into_a_package_and_the_tab_key_completes_a_message(tmp_path):
    checkout = make_checkout(tmp_path / 'checkout')
    shown = typed(checkout, 'roscd sample && echo "in $PWD"\n'
                            'tab rostopic pub /cmd_vel geometry_msgs/Twi; echo "types ${COMPREPLY[*]}"\n'
                            'tab rostopic pub /cmd_vel geometry_msgs/Twist ""; echo "message ${COMPREPLY[*]}"',
                  tmp_path)
    assert f'in {checkout}/.ws/src/sample\n' in shown
    assert 'types geometry_msgs/TwistStamped' in shown
    assert 'message "linear:\n  x: 0.0\n' in shown

# shellcheck shell=sh
# The Python and the libraries of a system that Rumba supports, in place of those of the system on which it is tested:
# ./rumba sources this file, for `./rumba test --platform NAME`. test/platforms/NAME.txt lists the
# versions for pip; its first line begins with the version of Python.

choose_platform() { # [NAME ...]
    known=$(cd "$root/test/platforms" && printf '%s ' *.txt | sed 's/\.txt//g')
    case " $known" in
        *" ${1:-} "*) ;;
        *) fail 2 "unknown platform '${1:-}': give one of these: ${known% }" ;;
    esac
    platform=$1 with_lessons=''
    requirements=$root/test/platforms/$platform.txt
    version=$(sed -n '1s/^# Python \([0-9.]*\):.*/\1/p' "$requirements")
    interpreter=$(find_python "$version") ||
        fail 1 "there is no Python $version, neither python$version in PATH nor in pyenv: pyenv install $version"
}

find_python() { # VERSION: one that works; pyenv's names in PATH may not
    for candidate in "$(command -v "python$1" || true)" "${PYENV_ROOT:-${HOME:-}/.pyenv}/versions/$1".*/bin/python3; do
        if [ -x "$candidate" ] && "$candidate" -c 'import venv' 2>/dev/null; then echo "$candidate"; return; fi
    done
    return 1
}

# Links the Python modules of ROS that the packages of this system hold, and none of their libraries.
link_ros() { # FOLDER
    dpkg-query -W -f '${db:Status-Status} ${source:Package} ${Package}\n' |
        sed -n 's/^installed \(ros-\|catkin\)[^ ]* //p' | xargs -r dpkg -L |
        sed -n 's|^/usr/lib/python3/dist-packages/[^/]*$|&|p' | sort -u | xargs -r ln -sft "$1"
    # Compiled for the Python of the system; rosbag, which needs it for some bags only, would say that it is not there.
    rm -f "$1/roslz4"
    : >"$1/roslz4.py"
    # The rostest of Debian 12 uses what Python 3.12 has dropped.
    echo 'import unittest; unittest.TestCase.assert_ = unittest.TestCase.assertTrue' >"$1/rostest.pth"
}

# Makes the virtual environment of the platform below its workspace, and puts it first in PATH.
enter_platform() {
    venv=$ws/venv python=$ws/venv/bin/python
    wanted=$("$interpreter" --version; cat "$requirements")
    if [ "$wanted" != "$(cat "$venv/wanted" 2>/dev/null || true)" ]; then
        log=$ws/pip.log
        : >"$log"
        rm -rf "$venv" "$ws/build" "$ws/devel"
        "$interpreter" -m venv "$venv"
        # Some of these packages are too old for today's Cython, and for pip's own way to build them.
        echo 'cython<3' >"$ws/constraint.txt"
        PIP_CONSTRAINT=$ws/constraint.txt with_progress "fetching the libraries of $platform" '' \
            "$python" -m pip install --progress-bar off -r "$requirements" ||
            fail 1 "they cannot be fetched: $(tail -n 1 "$log")"
        link_ros "$("$python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')"
        printf '%s\n' "$wanted" >"$venv/wanted"
    fi
    PATH=$venv/bin:$PATH
    # Beside the sources, a numba of another version would have its code replaced.
    export NUMBA_CACHE_DIR="$ws/cache" RUMBA_PLATFORM="$platform"
    # Of the modules of ROS, whose strings later Pythons warn of.
    export PYTHONWARNINGS=ignore::SyntaxWarning
}

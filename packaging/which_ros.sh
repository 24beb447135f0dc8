# shellcheck shell=sh
# Which ROS 1 ./rumba uses, and what the packages of the system are called with it. ./rumba sources this file; `root` is
# the folder of the checkout.

os_release=${RUMBA_OS_RELEASE:-/etc/os-release}
opt_ros=${RUMBA_OPT_ROS:-/opt/ros}

# Sets `prefixes`, the folders whose setup files lead to ROS 1, the uppermost first, with colons between, and
# `distribution`, the word in the names of its packages. Without prefixes, ROS 1 is that of the system, below /usr;
# without a distribution, so are its packages. One line on stderr says which it is.
find_ros() {
    UBUNTU_CODENAME='' VERSION_CODENAME='' PRETTY_NAME='this system'
    # shellcheck disable=SC1090 # the file's name is known only at run time
    [ ! -r "$os_release" ] || . "$os_release"
    codename=${UBUNTU_CODENAME:-$VERSION_CODENAME}
    sourced=$(sourced_prefixes)
    if [ -n "$sourced" ] && take "$sourced" "${ROS_DISTRO:-}" ', which is sourced'; then return; fi
    for name in one noetic; do
        if [ -d "$opt_ros/$name" ] && take "$opt_ros/$name" "$name"; then return; fi
    done
    prefixes='' distribution=''
    has_own_ros || no_ros
    say "$(ros_name)" >&2
}

has_own_ros() { # whether the system has packages of ROS 1 itself
    case $codename in
        bookworm | trixie | jammy) ;;
        *) return 1 ;;
    esac
}

no_ros() { # says what would do
    else_source='or source the setup file of a ROS 1 in another folder'
    case $codename in
        focal) fail 2 "$PRETTY_NAME has no ROS 1 of its own: install ROS Noetic, ros-noetic-ros-base, $else_source" ;;
        noble) fail 2 "$PRETTY_NAME has no ROS 1 of its own: install ROS One, ros-one-ros-base, $else_source" ;;
        *) fail 2 "$PRETTY_NAME is not supported: Debian 12 and 13 and Ubuntu 22.04 are with ROS 1 of their own," \
            "Ubuntu 20.04 with ROS Noetic, Ubuntu 24.04 with ROS One; $else_source" ;;
    esac
}

ros_name() {
    case $distribution in
        one) echo 'ROS One' ;;
        noetic) echo 'ROS Noetic' ;;
        *) echo "ROS 1 of $PRETTY_NAME" ;;
    esac
}

# Where the ROS 1 is that was found, in words; nothing if it is that of the system alone.
ros_place() {
    case $distribution:$prefixes in
        :) ;;
        :*) echo " below $(over "$prefixes")" ;;
        *) echo " in $(over "$prefixes")" ;;
    esac
}

over() { # PREFIXES: in words
    printf '%s\n' "$1" | sed 's/:/ over /g'
}

# Takes the ROS 1 to which setup files lead, and says which it is; if they lead to none, says why, and fails.
take() { # PREFIXES NAME [WHY]: the name of the distribution, if the setup files do not tell it
    if found=$(look "$@"); then
        distribution=${found%%:*} prefixes=${found#*:}
        say "$(ros_name)$(ros_place)${3:-}" >&2
    else
        say "$(over "$1")${3:+$3,} is passed over: ${found:-a setup file fails}" >&2
        return 1
    fi
}

# Sources setup files where nothing else is sourced. Prints the name of the distribution, a colon, and all folders to
# which they lead, or why that is no ROS 1.
look() ( # PREFIXES NAME [WHY]
    [ -e "${1%%:*}/setup.sh" ] || { echo 'it has no setup.sh'; exit 1; }
    forget_ros
    source_prefixes "$1" >/dev/null 2>&1 || exit 1
    led_to=${CMAKE_PREFIX_PATH:-$1}
    case :$led_to: in
        *":${1%%:*}:"*) ;;
        *) led_to=$1:$led_to ;;
    esac
    lacks=
    for package in catkin roscpp rospy; do
        provides "$package" "$led_to" || lacks=${lacks:-$package}
    done
    case $lacks:${ROS_DISTRO:=$2} in
        :one | :noetic) ;;
        ?*:* | : | :Debian) # a workspace over the ROS 1 of the system, if it is sourced
            if [ -z "${3:-}" ] || ! has_own_ros; then echo "it has no ${lacks:-ROS_DISTRO}"; exit 1; fi
            ROS_DISTRO= ;;
        *) echo "it is neither ROS One nor ROS Noetic, but ROS $ROS_DISTRO"; exit 1 ;;
    esac
    printf '%s:%s\n' "$ROS_DISTRO" "${led_to%:}"
)

# What is sourced: prefixes of catkin, with colons between. What was built over a workspace of ./rumba cannot be below it.
sourced_prefixes() (
    set -f
    IFS=: found=
    for prefix in ${CMAKE_PREFIX_PATH:-}; do
        if [ -f "${prefix%/*}/checkout" ]; then
            found=
        elif [ -e "$prefix/.catkin" ] && [ -e "$prefix/setup.sh" ]; then
            found=${found:+$found:}$prefix
        fi
    done
    printf '%s\n' "$found"
)

# What a pyenv, a conda, another workspace or a user's own Python packages put into the environment must not be found.
forget_ros() {
    PATH=/usr/bin:$(path_without_prefixes)
    unset PYTHONHOME PYTHONPATH CMAKE_PREFIX_PATH ROS_PACKAGE_PATH ROS_DISTRO
    export PATH PYTHONNOUSERSITE=1
}

# A setup file leaves what is in PATH already where it is, which may be behind another ROS.
path_without_prefixes() (
    set -f
    IFS=: kept=
    for folder in $PATH; do
        case :${CMAKE_PREFIX_PATH:-}: in
            *":${folder%/bin}:"*) [ "${folder%/bin}" = "$folder" ] || continue ;;
        esac
        kept=$kept:$folder
    done
    printf '%s\n' "${kept#:}"
)

source_prefixes() { # PREFIXES
    source_setup "${1%%:*}" || return
    led_to=${CMAKE_PREFIX_PATH:-}
    [ "${led_to%:}" != "$1" ] || return 0
    # The uppermost does not know all that is sourced below it.
    forget_ros
    export CATKIN_SETUP_UTIL_ARGS=--extend
    extend_by "$1" || return
    unset CATKIN_SETUP_UTIL_ARGS
}

extend_by() { # PREFIXES: from the lowest to the uppermost
    case $1 in *:*) extend_by "${1#*:}" || return ;; esac
    [ ! -e "${1%%:*}/setup.sh" ] || source_setup "${1%%:*}"
}

source_setup() { # FOLDER
    set +u
    _CATKIN_SETUP_DIR=$1 sourced_code=0
    # shellcheck disable=SC1091
    . "$1/setup.sh" || sourced_code=$?
    set -u
    return "$sourced_code"
}

provides() ( # PACKAGE PREFIXES: whether one of them has a package of ROS
    set -f
    IFS=:
    for prefix in $2; do
        [ ! -d "$prefix/share/$1" ] || exit 0
    done
    exit 1
)

wanted() { # ROLE ...: what packages.txt names for them with this ROS
    while read -r role debian ros; do
        case " $* " in *" $role "*) ;; *) continue ;; esac
        case $distribution:$ros in
            :* | *:=) echo "$debian" ;;
            *:-) ;;
            *) echo "ros-$distribution-$ros" ;;
        esac
    done <"$root/packages.txt" | tr _ -
}

missing() { # PACKAGE ...: those that are not installed
    installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "$@" 2>/dev/null || true)
    for package in "$@"; do
        case "
$installed
" in *"
installed $package
"*) continue ;; esac
        # A ROS in a folder of its own may have been built from source, without packages.
        case $package in "ros-$distribution-"*)
            if provides "$(echo "${package#"ros-$distribution-"}" | tr - _)" "$prefixes"; then continue; fi ;;
        esac
        echo "$package"
    done
}

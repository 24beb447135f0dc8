# shellcheck shell=sh
# A bare Debian 12 made by debootstrap: for scripts that source this file and are called with FOLDER [MIRROR]. Sets
# $folder, in which it will be.

bare_debian_arguments() { # SCRIPT [FOLDER [MIRROR]]: as the script was called
    script=$1 folder=${2:-} mirror=${3:-http://deb.debian.org/debian}
    [ -n "$folder" ] || {
        echo "$script: give the folder for a new Debian 12, which must not exist" >&2
        exit 2
    }
    [ ! -e "$folder" ] || {
        echo "$script: $folder exists: give a folder that does not" >&2
        exit 2
    }
}

make_bare_debian() { # CODENAME
    debootstrap --variant=minbase "$1" "$folder" "$mirror"
    cp /etc/resolv.conf "$folder/etc/resolv.conf"
}

inside() { # COMMAND ...: with /proc and terminals, and with all that it starts ended after it
    unshare --mount --pid --fork chroot "$folder" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
        sh -c 'mount -t proc proc /proc; mount -t devpts -o ptmxmode=666 devpts /dev/pts; exec "$@"' sh "$@" </dev/null
}

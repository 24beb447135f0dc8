#!/bin/sh
# Makes the pictures of the documentation: ./rumba shell docs/pictures/make.sh
# A mission in the apartment at ten times the speed, in a roscore of its own, without a display.
set -eu
cd "$(dirname -- "$0")"
export ROS_MASTER_URI="http://localhost:${PORT:-11399}" ROS_HOSTNAME=localhost QT_QPA_PLATFORM=offscreen

pids=
start() { # COMMAND ...: until this script ends
    "$@" >/dev/null 2>&1 &
    pids="$! $pids"
}
# shellcheck disable=SC2086 # several numbers
trap 'kill -INT $pids; wait' EXIT

swept() { rostopic echo -n1 /rumba/cleaning_status/coverage | head -n1; }
until_swept() { while ! swept | awk "{ exit !(\$1 >= $1) }"; do sleep 0.5; done; }
picture() { # VIEWER NAME
    made=$(rosservice call "/$1/save_png" | sed -n 's/^message: "\(.*\)"$/\1/p')
    mv "$made" "$2.png"
    python3 -c 'import sys; from PIL import Image; Image.open(sys.argv[1]).convert("RGB").quantize(
    256, Image.MEDIANCUT, kmeans=4, dither=0).save(sys.argv[1], optimize=True)' \
        "$2.png"
}

start roscore -p "${PORT:-11399}"
until rosparam get /run_id >/dev/null 2>&1; do sleep 0.2; done
start roslaunch rumba_bringup demo.launch speed:=10 gui:=false
start rosrun rumba_viewer viewer __name:=light _style:=light _laser:=true _folder:=/tmp _width:=1100 _height:=660
start rosrun rumba_viewer viewer __name:=dark _style:=dark _folder:=/tmp _width:=1100 _height:=660
rosservice call --wait /simulator/spawn '{pose: {x: 2.0, y: 4.6, theta: 2.0}}' >/dev/null
until_swept 0.45
picture light window
until_swept 0.7
picture dark dark

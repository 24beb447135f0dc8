#!/bin/sh
# Makes the pictures of the documentation, about five minutes: ./rumba shell docs/pictures/make.sh
# A mission in the apartment at twenty times the speed, in a roscore of its own, without a display: the window light and
# dark, a GIF of it, the page in a phone and on a desk, and the report of the mission; a robot that makes its own map; and
# the paths of two robots that share it. Needs chromium, chromium-driver and python3-selenium for page and report.
set -eu
cd "$(dirname -- "$0")"
port=${PORT:-11399}
export ROS_MASTER_URI="http://localhost:$port" ROS_HOSTNAME=localhost QT_QPA_PLATFORM=offscreen
folder=$(mktemp -d)

pids=
start() { # COMMAND ...: until this script ends
    "$@" >"$folder/log" 2>&1 &
    pids="$! $pids"
}
# shellcheck disable=SC2086 # several numbers
trap 'kill -INT $pids 2>/dev/null || true; wait; rm -rf "$folder"' EXIT

value() { rostopic echo -n1 "/rumba/$1" | head -n1; } # TOPIC/FIELD
until_swept() { until value cleaning_status/coverage | awk "{ exit !(\$1 >= $1) }"; do sleep 0.5; done; }
save() { rosservice call "/$1/save_png" | sed -n 's/^message: "\(.*\)"$/\1/p'; } # VIEWER: prints the path
# Each viewer has a folder of its own: names of pictures have seconds only.
viewer() { # NAME STYLE
    start rosrun rumba_viewer viewer __name:="$1" _style:="$2" _folder:="$folder/$1" _width:=1100 _height:=700
}
shoot() { python3 shoot.py "$@"; } # see there
frames() { # a picture of the window every second, as long as the mission goes on
    number=1000
    until value mission_status/state | grep -qx 0; do
        number=$((number + 1))
        mv "$(save film)" "$folder/frame$number.png"
    done
}

start roscore -p "$port"
until rosparam get /run_id >/dev/null 2>&1; do sleep 0.2; done
viewer film light
viewer light light
viewer dark dark
start rosrun rumba_viewer page _port:=$((port + 1))
start roslaunch rumba_launch demo.launch speed:=20 drain:=4 gui:=false
demo=$!
start rosbag record -O "$folder/mission.bag" /map /rumba/ground_truth /rumba/battery_state /rumba/cleaning_status \
    /rumba/bumper /rumba/dock_status /rumba/mission_status /rumba/coverage
recorder=$!
until_swept 0.02
frames &
filming=$!
until_swept 0.45
mv "$(save light)" window.png
shoot page "http://127.0.0.1:$((port + 1))" page.png 1100x700
shoot page "http://127.0.0.1:$((port + 1))" phone.png 360x740
rosservice call /simulator/spawn '{pose: {x: 5.6, y: 3.9, theta: 2.0}}' >/dev/null
sleep 1
mv "$(save dark)" dark.png
rosservice call /simulator/kill '{name: rumba2}' >/dev/null
wait "$filming"
sleep 2
kill -INT "$recorder"
while [ ! -e "$folder/mission.bag" ]; do sleep 0.2; done
rosrun rumba_evaluation mission_report "$folder/mission.bag"
shoot report "file://$folder/mission.html" report.png 1100x1250
shoot gif "$folder"/frame*.png mission.gif
kill -INT "$demo"
wait "$demo" || true
start roslaunch rumba_launch demo.launch localisation:=slam speed:=5 gui:=false
until value cleaning_status/distance | awk '{ exit !($1 >= 4 && $1 < 20) }'; do sleep 0.2; done
mv "$(save light)" own_map.png
rosrun rumba_evaluation evaluate --maps apartment_docks --strategies boustrophedon --robots 2 --seeds 1 \
    --output "$folder/team"
cp "$folder/team/path_apartment_docks_boustrophedon_2.png" fleet.png
shoot shrink window.png dark.png own_map.png page.png phone.png report.png fleet.png

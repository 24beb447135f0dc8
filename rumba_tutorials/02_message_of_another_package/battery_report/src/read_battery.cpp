// Prints each BatteryStatus that arrives on rumba/battery_status.

#include <ros/ros.h>

#include "rumba_msg/BatteryStatus.h"

void show(const rumba_msg::BatteryStatus& status)
{
  ROS_INFO("%ld %%, at (%.1f, %.1f), brushes %s", static_cast<long>(status.percentage_battery), status.location_x,
           status.location_y, status.brushes_up ? "up" : "down");
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "read_battery", ros::init_options::AnonymousName);
  ros::NodeHandle node;
  ros::Subscriber subscriber = node.subscribe("rumba/battery_status", 1000, show);
  ros::spin();
}

#include <ros/ros.h>

#include "rumba_msg/BatteryStatus.h"

int main(int argc, char** argv)
{
  ros::init(argc, argv, "publisher");
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<rumba_msg::BatteryStatus>("rumba/battery_status", 1000);
  ros::Rate rate(10);
  rumba_msg::BatteryStatus status;
  status.percentage_battery = 42;
  status.location_x = 1.5;
  status.location_y = -2.5;
  status.orientation_theta = 0.75;
  status.brushes_up = true;
  status.debug_message = "from C++";
  while (ros::ok())
  {
    publisher.publish(status);
    rate.sleep();
  }
}

// Publishes a BatteryStatus five times a second, as the lesson on rumba_msg does; the battery loses 1 % each time.

#include <ros/ros.h>

#include "rumba_msg/BatteryStatus.h"

int main(int argc, char** argv)
{
  ros::init(argc, argv, "publish_battery");
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<rumba_msg::BatteryStatus>("rumba/battery_status", 1000);
  rumba_msg::BatteryStatus status;
  status.percentage_battery = 100;
  status.location_x = 1.5;
  status.location_y = -2.5;
  status.orientation_theta = 0.75;
  status.brushes_up = true;
  status.debug_message = "from C++";
  for (ros::Rate rate(5); ros::ok() && status.percentage_battery > 0; rate.sleep())
  {
    publisher.publish(status);
    --status.percentage_battery;
  }
}

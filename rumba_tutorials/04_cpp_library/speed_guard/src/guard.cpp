// Publishes each command of cmd_vel_raw on cmd_vel, limited to ~max_linear [m/s] and ~max_angular [rad/s].

#include <geometry_msgs/Twist.h>
#include <ros/ros.h>

#include "speed_limit/limit.h"

int main(int argc, char** argv)
{
  ros::init(argc, argv, "guard");
  ros::NodeHandle node;
  ros::NodeHandle own("~");
  const double max_linear = own.param("max_linear", 0.1);
  const double max_angular = own.param("max_angular", 1.0);
  if (!(max_linear > 0.0 && max_angular > 0.0))
  {
    ROS_FATAL("max_linear is %g, max_angular is %g: both must be above 0", max_linear, max_angular);
    return 2;
  }
  ros::Publisher publisher = node.advertise<geometry_msgs::Twist>("cmd_vel", 1);
  ros::Subscriber subscriber = node.subscribe<geometry_msgs::Twist>(
      "cmd_vel_raw", 1, [&](const geometry_msgs::Twist::ConstPtr& command) {
        publisher.publish(speed_limit::limited(*command, max_linear, max_angular));
      });
  ros::spin();
}

// Prints the sum of each pair that arrives on two_ints.

#include <ros/ros.h>

#include "aa/two_ints.h"

void add(const aa::two_ints& pair)
{
  ROS_INFO("%d + %d = %d", pair.a1, pair.b1, pair.a1 + pair.b1);
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "listener");
  ros::NodeHandle node;
  ros::Subscriber subscriber = node.subscribe("two_ints", 10, add);
  ros::spin();
}

#include <iostream>

#include <ros/ros.h>
#include <turtlesim/Pose.h>
#include <turtlesim/Spawn.h>

void onPose(const turtlesim::Pose::ConstPtr& pose)
{
  if (pose->x > 5.0)
  {
    std::cout << pose->x << std::endl;
    ros::shutdown();
  }
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "watcher");
  ros::NodeHandle node;
  ros::ServiceClient spawn = node.serviceClient<turtlesim::Spawn>("spawn");
  spawn.waitForExistence();
  ros::Subscriber poses = node.subscribe("turtle1/pose", 10, onPose);
  ros::spin();
  return 0;
}

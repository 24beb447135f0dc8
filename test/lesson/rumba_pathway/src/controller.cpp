// The controller of the lesson: turns to the heading that the server answers, then drives with the speed beside it.
//
// Reads targets from the terminal, X Y THETA in a line, and prints where the turtle stands after each. A turtle that the
// machine was too busy to stop in time has left its target again: it is sent back.
#include <cmath>
#include <iostream>

#include <geometry_msgs/Twist.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <turtlesim/Pose.h>

#include "rumba_msg/TargetPosition.h"

namespace
{
turtlesim::Pose pose;
bool is_new = false;

void take(const turtlesim::PoseConstPtr& newest)
{
  pose = *newest;
  is_new = true;
}

// Waits for the next pose; returns whether there is one.
bool hear()
{
  for (is_new = false; ros::ok() && !is_new;)
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
  return is_new;
}
}  // namespace

int main(int argc, char** argv)
{
  ros::init(argc, argv, "controller");
  ros::NodeHandle node;
  ros::Subscriber poses = node.subscribe("turtle1/pose", 1, take);
  ros::Publisher wheels = node.advertise<geometry_msgs::Twist>("turtle1/cmd_vel", 1);
  ros::ServiceClient client = node.serviceClient<rumba_msg::TargetPosition>("go_to_position");
  client.waitForExistence();
  double threshold = 0.0;
  node.getParam("/threshold_parameter", threshold);
  rumba_msg::TargetPosition call;
  while (std::cin >> call.request.target_x >> call.request.target_y >> call.request.target_theta)
  {
    bool is_there = false;
    bool is_standing = false;
    while (!(is_there && is_standing) && hear())
    {
      if (!client.call(call) || !call.response.feedback)
        continue;
      const double away = std::hypot(call.request.target_x - pose.x, call.request.target_y - pose.y);
      const bool is_aligned = std::abs(pose.theta - call.response.angular_z) < threshold;
      is_there = is_aligned && away < threshold;
      is_standing = pose.linear_velocity == 0.0F && pose.angular_velocity == 0.0F;
      geometry_msgs::Twist twist;
      if (!is_aligned)
        twist.angular.z = 1.0;
      else if (!is_there)
        twist.linear.x = call.response.linear_x;
      wheels.publish(twist);
    }
    std::cout << "at " << pose.x << " " << pose.y << std::endl;
  }
}

// The server of the lesson: answers the heading that points away from the target, and a speed to back up to it.
#include <cmath>

#include <ros/ros.h>
#include <turtlesim/Pose.h>

#include "rumba_msg/TargetPosition.h"

int main(int argc, char** argv)
{
  ros::init(argc, argv, "server");
  ros::NodeHandle node;
  turtlesim::Pose pose;
  ros::Subscriber poses = node.subscribe<turtlesim::Pose>(
      "turtle1/pose", 1, [&pose](const turtlesim::PoseConstPtr& newest) { pose = *newest; });
  ros::ServiceServer server = node.advertiseService<rumba_msg::TargetPositionRequest, rumba_msg::TargetPositionResponse>(
      "go_to_position", [&pose](rumba_msg::TargetPositionRequest& target, rumba_msg::TargetPositionResponse& answer) {
        answer.angular_z = std::atan2(pose.y - target.target_y, pose.x - target.target_x);
        answer.linear_x = -1.0;
        answer.feedback = true;
        answer.message = "from C++";
        return true;
      });
  ros::spin();
}

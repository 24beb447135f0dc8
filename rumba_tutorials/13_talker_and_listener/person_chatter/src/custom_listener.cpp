// Prints each Person that arrives on custom_chatter.

#include <ros/ros.h>

#include "person_chatter/Person.h"

void show(const person_chatter::Person& person)
{
  ROS_INFO("%s is %d years old", person.name.c_str(), person.age);
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "custom_listener", ros::init_options::AnonymousName);
  ros::NodeHandle node;
  ros::Subscriber subscriber = node.subscribe("custom_chatter", 10, show);
  ros::spin();
}

// Publishes a Person on custom_chatter, ten times a second.

#include <ros/ros.h>

#include "person_chatter/Person.h"

int main(int argc, char** argv)
{
  ros::init(argc, argv, "custom_talker", ros::init_options::AnonymousName);
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<person_chatter::Person>("custom_chatter", 10);
  person_chatter::Person person;
  person.name = "Grace";
  person.age = 37;
  for (ros::Rate rate(10); ros::ok(); rate.sleep())
  {
    publisher.publish(person);
  }
}

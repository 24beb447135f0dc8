// Publishes two numbers on two_ints, ten times a second.

#include <ros/ros.h>

#include "aa/two_ints.h"

int main(int argc, char** argv)
{
  ros::init(argc, argv, "talker");
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<aa::two_ints>("two_ints", 10);
  aa::two_ints pair;
  pair.a1 = 3;
  pair.b1 = -5;
  for (ros::Rate rate(10); ros::ok(); rate.sleep())
  {
    publisher.publish(pair);
  }
}

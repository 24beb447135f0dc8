// Prints the first bytes of one packet, as characters and as numbers. uint8[] is a std::vector<uint8_t> in C++, and
// uint8_t is a kind of char: streams and %c show a letter, %d and a conversion to int show the number.

#include <cstdio>
#include <iostream>

#include <ros/ros.h>

#include "lists_and_bytes/Packet.h"

void show(const lists_and_bytes::Packet::ConstPtr& packet)
{
  if (packet->payload.empty())
    return;
  const uint8_t last = packet->payload.back();
  std::cout << "as a letter " << last << ", as a number " << static_cast<int>(last) << std::endl;
  std::printf("%%c prints %c, %%d prints %d, of %zu bytes\n", last, last, packet->payload.size());
  std::fflush(stdout);
  ros::shutdown();
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "letters");
  ros::NodeHandle node;
  ros::Subscriber subscriber = node.subscribe("rumba/letters", 1, show);
  ros::spin();
}

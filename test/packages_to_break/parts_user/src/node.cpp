#include "parts_lib/count.h"
#include "parts_msgs/Parts.h"
#include <ros/console.h>

int main()
{
  parts_msgs::Parts parts;
  parts.places.poses.resize(parts_lib::count());
  ROS_INFO("%zu places", parts.places.poses.size());
}

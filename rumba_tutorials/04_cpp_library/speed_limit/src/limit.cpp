#include "speed_limit/limit.h"

#include <algorithm>
#include <cmath>

namespace speed_limit
{

geometry_msgs::Twist limited(const geometry_msgs::Twist& command, double max_linear, double max_angular)
{
  const double linear = command.linear.x;
  const double angular = command.angular.z;
  geometry_msgs::Twist slower;
  if (std::isfinite(linear) && std::isfinite(angular))
  {
    // How many times faster than allowed; the same factor for both velocities keeps the curve.
    const double excess = std::max({ 1.0, std::fabs(linear) / max_linear, std::fabs(angular) / max_angular });
    slower.linear.x = linear / excess;
    slower.angular.z = angular / excess;
  }
  return slower;
}

}  // namespace speed_limit

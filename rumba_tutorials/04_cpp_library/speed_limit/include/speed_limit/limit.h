#ifndef SPEED_LIMIT_LIMIT_H
#define SPEED_LIMIT_LIMIT_H

#include <geometry_msgs/Twist.h>

namespace speed_limit
{

/// The same curve as `command`, driven so slowly that neither limit is broken; a stop where it is not finite.
///
/// `max_linear` [m/s] bounds linear.x and `max_angular` [rad/s] angular.z, both forward and backward.
geometry_msgs::Twist limited(const geometry_msgs::Twist& command, double max_linear, double max_angular);

}  // namespace speed_limit

#endif

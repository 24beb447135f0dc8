#ifndef SPEED_LIMIT_LIMIT_H
#define SPEED_LIMIT_LIMIT_H

#include <geometry_msgs/Twist.h>

namespace speed_limit
{

/// Returns `command`, slowed down to obey both limits on the same curve; a stop if `command` is not finite.
///
/// `max_linear` [m/s] limits linear.x, forward and backward; `max_angular` [rad/s] limits angular.z in both directions.
geometry_msgs::Twist limited(const geometry_msgs::Twist& command, double max_linear, double max_angular);

}  // namespace speed_limit

#endif

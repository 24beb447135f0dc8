"""A node that subscribes to every topic and prints at its end how many messages of each arrived."""

import collections

import roslib.message
import rospy

SETTLE = 2.0  # [s] until all connections are established


def main():
    """Listen until interrupted."""
    rospy.init_node('listener', disable_rostime=True, disable_rosout=True)
    sequences = collections.defaultdict(list)
    subscribers = [rospy.Subscriber(topic, roslib.message.get_message_class(kind), sequence_keeper(sequences[topic]))
                   for topic, kind in rospy.get_published_topics() if not topic.startswith('/rosout')]
    rospy.rostime.wallsleep(SETTLE)
    print('listening', flush=True)
    rospy.spin()
    for subscriber in subscribers:
        numbers = sequences[subscriber.resolved_name]
        if numbers:
            print(subscriber.resolved_name, len(numbers), numbers[-1] - numbers[0] + 1)


def sequence_keeper(numbers):
    """A callback that keeps the sequence number of each message that has one."""
    def keep(message):
        if hasattr(message, 'header'):
            numbers.append(message.header.seq)
    return keep


if __name__ == '__main__':
    main()

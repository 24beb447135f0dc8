"""Topics without a master."""


class Connections:
    """What a topic of rospy has until it is unregistered."""

    def __init__(self):
        self.number = 1

    def get_num_connections(self):
        return self.number


class Topic:
    """A fake publisher or subscriber of rospy.

    Attributes:
        opened: all of them by the name of the topic.
    """

    opened = {}

    def __init__(self, name, kind, callback=None, queue_size=None):
        self.kind, self.callback, self.published, self.impl = kind, callback, [], Connections()
        self.opened[name] = self

    def publish(self, message):
        self.published.append(message)

    def get_num_connections(self):
        return self.impl.get_num_connections()

    def unregister(self):
        self.impl = None

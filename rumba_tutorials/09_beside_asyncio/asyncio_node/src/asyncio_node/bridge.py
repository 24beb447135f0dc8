"""Connects rospy, which has threads and signal handlers of its own, with an asyncio loop."""

import asyncio
import signal
from typing import Any, Callable

import rospy


def run(name: str, main: Callable[[], Any]) -> None:
    """Run a coroutine as a node until it ends, Ctrl-C is pressed, or ROS shuts down; then end both."""
    # The handler of rospy for Ctrl-C would end ROS, but not the loop.
    rospy.init_node(name, disable_signals=True)
    try:
        asyncio.run(_until_shutdown(main()))
    finally:
        rospy.signal_shutdown('the loop has ended')


async def _until_shutdown(main: Any) -> None:
    task = asyncio.ensure_future(main)
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, task.cancel)
    rospy.on_shutdown(lambda: loop.is_closed() or loop.call_soon_threadsafe(task.cancel))  # `rosnode kill`
    try:
        await task
    except asyncio.CancelledError:
        pass


def subscribe(topic: str, kind: Any, callback: Callable[[Any], None]) -> rospy.Subscriber:
    """Have the running loop call a function with each message, in the thread of the loop."""
    loop = asyncio.get_running_loop()
    # rospy runs callbacks in other threads, and no other method of a loop may be called from those.
    return rospy.Subscriber(topic, kind, lambda message: loop.call_soon_threadsafe(callback, message))

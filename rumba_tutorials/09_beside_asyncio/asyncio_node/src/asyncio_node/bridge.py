"""From rospy's threads into an asyncio loop, and its signals out of the way."""

import asyncio
import signal
from typing import Any, Callable

import rospy


def run(name: str, main: Callable[[], Any]) -> None:
    """Run a coroutine as a node, until it ends, Ctrl-C is pressed, or ROS ends the node; then end both."""
    # rospy's own handler for Ctrl-C would end ROS and leave the loop running.
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
    rospy.on_shutdown(lambda: loop.is_closed() or loop.call_soon_threadsafe(task.cancel))  # as by `rosnode kill`
    try:
        await task
    except asyncio.CancelledError:
        pass


def subscribe(topic: str, kind: Any, callback: Callable[[Any], None]) -> rospy.Subscriber:
    """Have the running loop call back with each message, in its own thread."""
    loop = asyncio.get_running_loop()
    # Of asyncio, only this may be called from another thread, and rospy's callbacks are in one.
    return rospy.Subscriber(topic, kind, lambda message: loop.call_soon_threadsafe(callback, message))

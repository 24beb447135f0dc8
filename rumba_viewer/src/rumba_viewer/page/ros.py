"""What sessions of clients ask of ROS."""

import abc
from typing import Any, Callable, Optional

from rumba_viewer.page.feeds import Demand

Done = Callable[[bool, Any], None]  # gets whether a call worked; and the answer, or a line that says why not


class Ros(abc.ABC):
    """What a session asks of ROS; each method may raise a Refusal. `client` identifies the client."""

    @abc.abstractmethod
    def subscribe(self, client: Any, topic: str, reason: Any, demand: Demand) -> None:
        """Send the messages of a topic to a client."""

    @abc.abstractmethod
    def unsubscribe(self, client: Any, topic: str, reason: Any) -> None:
        """No longer send them; reason None: for no reason."""

    @abc.abstractmethod
    def kind(self, topic: str) -> str:
        """The type of a topic; empty if it is not known."""

    @abc.abstractmethod
    def advertise(self, client: Any, topic: str, kind: Optional[str], latch: bool) -> None:
        """Prepare to publish messages of a type; None: that which the topic has."""

    @abc.abstractmethod
    def unadvertise(self, client: Any, topic: str) -> None:
        """The client no longer publishes."""

    @abc.abstractmethod
    def publish(self, client: Any, topic: str, values: Any) -> None:
        """Publish a message with these values on a topic that the client has advertised."""

    @abc.abstractmethod
    def call(self, client: Any, service: str, values: Any, done: Done, timeout: float) -> None:
        """Call a service; `done` gets the answer, or that there was none in so many seconds; 0: wait for it."""

    @abc.abstractmethod
    def serve(self, client: Any, service: str, kind: str, ask: Callable[[str, Any], None],
              tell: Callable[[str, str], None]) -> None:
        """Serve a service on behalf of a client: `ask` gets an id and the values of each request, for `answer`.

        `tell` gets a level and a line if there is something to say; after an error, the service is not served.
        """

    @abc.abstractmethod
    def unserve(self, client: Any, service: str) -> None:
        """The client no longer serves it."""

    @abc.abstractmethod
    def answer(self, client: Any, service: str, request: Any, worked: bool, values: Any) -> None:
        """Answer a request by its id: with values, or with a line that says why it did not work."""

    @abc.abstractmethod
    def leave(self, client: Any) -> None:
        """Forget a client, which has given back its topics and services."""

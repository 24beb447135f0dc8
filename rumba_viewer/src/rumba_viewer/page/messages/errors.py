"""What goes wrong between the page and its clients; each becomes one line that the client gets."""

from rumba_sim.model.common.errors import RumbaError


class Refusal(RumbaError):
    """An operation is not carried out; the client stays connected."""


class Hostile(RumbaError):
    """The client broke a bound or sent what no client sends; it is told so, and its connection ends."""

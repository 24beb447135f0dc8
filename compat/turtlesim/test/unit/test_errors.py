"""Messages are one short line, whatever names other nodes send."""

from turtlesim.model.errors import TurtlesimError


def test_control_characters_are_escaped_and_long_messages_are_cut():
    assert str(TurtlesimError('there is no turtle [\x1b[2J\n\u202e]')) == 'there is no turtle [\\x1b[2J\\n\\u202e]'
    assert len(str(TurtlesimError(5_000_000 * 'a'))) < 310

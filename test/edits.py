"""What a reader writes into a file, by a box of a lesson.

A box for a new file is the whole file. A box for a file that exists is a part of it after the edit. The first and the
last line of the box are in the file already; the lines between them in the box replace those between them in the file.
"""


def edited(text: str, box: str) -> str:
    """The text of a file after an edit.

    Raises:
        AssertionError: the first line of the box is not in the file exactly once, or the last one does not follow it.
    """
    if not text:
        return box
    lines, part = text.splitlines(), box.splitlines()
    assert lines.count(part[0]) == 1, f'{lines.count(part[0])} times in the file: {part[0]}'
    begin = lines.index(part[0])
    assert part[-1] in lines[begin + 1:], f'not in the file after the first line of the box: {part[-1]}'
    end = lines.index(part[-1], begin + 1)
    return '\n'.join([*lines[:begin], *part, *lines[end + 1:], ''])

"""What tools printed about made-up mistakes, word by word; only folders have other names."""

import pathlib


def sections(name):
    """The texts of a file beside this one, by their titles: lines that begin with ====."""
    text = pathlib.Path(__file__).with_name(name).read_text(encoding='utf-8')
    return dict(part.split('\n', 1) for part in text.split('==== ')[1:])

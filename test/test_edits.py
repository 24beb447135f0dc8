"""A box of a lesson changes a file as its reader would."""

import pytest
from edits import edited

TEMPLATE = 'find(\n  a\n)\n\n# add(\n# )\n\n## end\n'


def test_a_box_replaces_what_stands_between_its_first_and_its_last_line():
    assert edited(TEMPLATE, 'find(\n  a\n  b\n)\n') == 'find(\n  a\n  b\n)\n\n# add(\n# )\n\n## end\n'


def test_a_box_for_a_new_file_is_the_file():
    assert edited('', 'one\ntwo\n') == 'one\ntwo\n'


@pytest.mark.parametrize('box, complaint', [
    ('seek(\n)\n', '0 times in the file: seek'), ('## end\nmore\n)\n', 'not in the file after the first line'),
    ('\n  b\n)\n', '2 times in the file')])
def test_a_box_that_does_not_fit_the_file_is_found(box, complaint):
    with pytest.raises(AssertionError, match=complaint):
        edited(TEMPLATE, box)

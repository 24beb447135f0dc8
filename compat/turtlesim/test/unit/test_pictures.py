"""Pictures go to files of their own, whatever name another node has set."""

import pytest
from PIL import Image

from turtlesim import pictures
from turtlesim.model.errors import TurtlesimError

PICTURE = Image.new('RGB', (4, 3), (1, 2, 3))


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """The folder of the pictures."""
    monkeypatch.setenv('ROS_HOME', str(tmp_path))
    return tmp_path / 'turtlesim'


def test_a_picture_is_written_and_replaced_and_nothing_else_is_left(folder):
    for colour in ((1, 2, 3), (4, 5, 6)):
        path = pictures.save(Image.new('RGB', (4, 3), colour), 'field.png')
        with Image.open(path) as found:
            assert found.getpixel((0, 0)) == colour
    assert list(folder.iterdir()) == [path] == [folder / 'field.png']


@pytest.mark.parametrize('name', [
    '', '/etc/passwd', '/tmp/a.png', '../a.png', 'a/b.png', '.bashrc', '.png', 'field', 'a.png\n', 100 * 'a' + '.png',
    5, None, ['a.png']])
def test_other_names_are_no_names_of_pictures(name):
    assert not pictures.is_name(name)


@pytest.mark.parametrize('name', ['a.png', 'turtlesim.png', 'my-field_2.1.png'])
def test_names_of_pictures(name):
    assert pictures.is_name(name)


def test_a_file_that_is_no_picture_is_not_replaced(folder):
    folder.mkdir()
    (folder / 'notes.png').write_text('precious')
    with pytest.raises(TurtlesimError, match=r'/notes\.png is not a picture: delete it, or choose another name$'):
        pictures.save(PICTURE, 'notes.png')
    assert (folder / 'notes.png').read_text() == 'precious'


def test_a_link_is_not_followed(folder, tmp_path):
    folder.mkdir()
    other = tmp_path / 'other.png'
    PICTURE.save(other)
    before = other.read_bytes()
    (folder / 'link.png').symlink_to(other)
    (folder / 'nowhere.png').symlink_to(tmp_path / 'new.png')
    for name in ('link.png', 'nowhere.png'):
        with pytest.raises(TurtlesimError, match='is not a picture'):
            pictures.save(Image.new('RGB', (9, 9)), name)
    assert other.read_bytes() == before and not (tmp_path / 'new.png').exists()


def test_a_folder_of_that_name_is_refused(folder):
    (folder / 'field.png').mkdir(parents=True)
    with pytest.raises(TurtlesimError, match='is not a picture'):
        pictures.save(PICTURE, 'field.png')


def test_what_cannot_be_written_leaves_nothing_behind(folder, monkeypatch):
    def full(*_):
        raise OSError('No space left on device')
    monkeypatch.setattr(Image.Image, 'save', full)
    with pytest.raises(OSError, match='No space left'):
        pictures.save(PICTURE, 'field.png')
    assert list(folder.iterdir()) == []

"""Saves pictures of the window, and records its floor."""

import pathlib
from typing import Any, Callable, Optional

from PyQt5.QtWidgets import QWidget

from rumba_viewer.window.files import new_file
from rumba_viewer.window.floor_view import FloorView
from rumba_viewer.window.recorder import Recorder


class Pictures:
    """What the window saves to files."""

    def __init__(self, window: QWidget, floor: FloorView, folder: str, tell: Callable[[str], None],
                 write: Callable[[Any, pathlib.Path], None]) -> None:
        """Save below a folder.

        Args:
            window: what is saved as PNG.
            floor: what is recorded as GIF.
            folder: where; empty: the default of `new_file`.
            tell: shows a line to a person.
            write: writes a record to a path, without making the window wait.
        """
        self._window, self._floor, self._folder = window, floor, folder
        self._tell, self._write = tell, write
        self._recorder: Optional[Recorder] = None

    @property
    def is_recording(self) -> bool:
        """Whether a record was started."""
        return self._recorder is not None

    @property
    def recorded(self) -> float:
        """How long the record is by now [s]."""
        return self._recorder.duration if self._recorder is not None else 0.0

    def save(self) -> None:
        """Save a picture under a new name, and tell its path or what went wrong."""
        try:
            self._tell(f'saved {self.save_anywhere()}')
        except OSError as error:
            self._tell(f'not saved: {error}')

    def save_anywhere(self) -> pathlib.Path:
        """Save a picture under a new name; returns its path.

        Raises:
            OSError: it cannot be written.
        """
        path = new_file(self._folder, 'png')
        self.save_as(path)
        return path

    def save_as(self, path: pathlib.Path) -> None:
        """Save a picture, without notices.

        Raises:
            OSError: it cannot be written.
        """
        self._floor.show_notice('')
        path.parent.mkdir(parents=True, exist_ok=True)
        if not self._window.grab().save(str(path), 'PNG'):
            raise OSError(f'{path}: cannot be written')

    def switch_record(self) -> None:
        """Start a record, or end it and write it."""
        if self._recorder is None:
            self._recorder = Recorder()
        else:
            self._end(self._recorder)

    def add_frame(self) -> None:
        """Add what the floor shows now to the record, if there is one."""
        if self._recorder is not None:
            self._recorder.add(self._floor.grab().toImage())
            if self._recorder.is_full:
                self._end(self._recorder)

    def _end(self, recorder: Recorder) -> None:
        self._recorder = None
        self._write(recorder, new_file(self._folder, 'gif'))

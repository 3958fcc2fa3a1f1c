"""Players that Python and the reader move together, and a canvas to draw a path on.

Here `anywidget` runs the player's scripts. Scenes are numbered: a frame that the browser sent while another
scene was shown does not count.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body.motion import Motion
from mocap.errors import MocapError, MocapWarning
from mocap.widgets.live import Live, display_live, widget
from mocap.widgets.player import Player, play

Follow = Callable[[Array], Motion | Player]


class LivePlayer(Live):
    """A player with a `frame` that Python may set and observe."""

    scripts = Player.scripts
    shared: ClassVar = {
        "scene": {},
        "at": [-1, 0],  # the browser's: the number of a scene, and a frame
        "move": [0, 0],  # Python's
        "path": [],
        "message": "",
    }
    kept: ClassVar = {"frame": 0}
    needs = "A linked player needs"
    player: Player
    scene: Any
    known = False  # whether the browser knows the frame that is being set

    def show(self, player: Player, **extra: bool) -> None:
        """Show another player in the same place, from its first frame on."""
        self.player = player
        with self.silent():
            self.frame = 0  # before the new scene, which may have fewer frames
        self.scene = player.scene | extra | {"number": self.scene["number"] + 1}

    @contextmanager
    def silent(self) -> Iterator[None]:
        """Set `frame` without a word to the browser, where it is known already."""
        self.known = True
        try:
            yield
        finally:
            self.known = False

    def check_frame(self, frame: int) -> int:
        """Refuse a frame that the scene does not have."""
        frames = self.scene["frames"]
        if not 0 <= frame < frames:
            raise MocapError(f"The player has frames 0 to {frames - 1}, not {frame}.")
        return int(frame)

    def reader_moves(self, change: dict[str, Any]) -> None:
        """Take the frame that the browser shows, if it is one of this scene."""
        number, frame = change["new"]
        if number == self.scene["number"]:
            with self.silent():
                self.frame = frame

    def python_moves(self, change: dict[str, Any]) -> None:
        """Send the browser a frame that Python has set."""
        if not self.known:
            self.move = [self.scene["number"], change["new"]]

    def __repr__(self) -> str:
        return f"LivePlayer({self.player.alt!r})"

    def _ipython_display_(self) -> None:
        display_live(self.player._repr_mimebundle_(), self)


def linked(player: Player) -> Any:  # noqa: ANN401
    """Link a player to Python: set its `frame` to move it, observe its `frame` to follow the reader.

    Parameters
    ----------
    player : as from `play`.

    Returns
    -------
    A widget with the trait `frame`; a notebook shows it as the last line of a cell.

    Raises
    ------
    MocapError : where anywidget is not installed; later, when `frame` is set to one that does not exist.

    Examples
    --------
    >>> from mocap import datasets
    >>> walk = linked(play(datasets.sample("walk_straight")))
    >>> walk.observe(lambda change: print("now at", change.new), "frame")
    >>> walk.frame = 12
    now at 12
    """
    live = widget(LivePlayer)(scene=player.scene | {"reports": True})
    live.player = player
    live.observe(live.reader_moves, "at")
    live.observe(live.python_moves, "frame")
    return live


def draw_path(follow: Follow, path: ArrayLike) -> Any:  # noqa: ANN401
    """Let the reader draw a path on the ground, and show a walk along it.

    Parameters
    ----------
    follow : called with a path, shape (N, 2), points (x, z) in metres; returns a motion, or a `play` of one.
        Its `alt`, which can say how far off the path the walk is, and all warnings stand below the canvas.
        Its `path`, if it has one, is drawn instead of the reader's line: give there what was followed, such
        as a spline.
    path : the first path, shape (N, 2).

    Returns
    -------
    A linked player; its `path` is what the reader drew last, its `error` what `follow` raised there, or None.

    Raises
    ------
    MocapError : where anywidget is not installed.
    Exception : whatever `follow` raises at the first path. Later, the canvas shows the error.

    Examples
    --------
    >>> from mocap import datasets
    >>> canvas = draw_path(lambda path: datasets.sample("jog")[: 40 * len(path)], [(0, 0), (0, 3)])
    >>> canvas.path = [(0, 0), (0, 2), (1, 4)]  # as a reader draws it
    >>> canvas.error is None, len(canvas.player.motions[0])
    (True, 120)

    Notebook: 08-path-synthesis
    """
    on_canvas = {"drawable": True, "follow": False, "reports": False}
    points = np.reshape(np.asarray(path, float), (-1, 2))
    player, message = _along(follow, points)
    canvas = linked(player)
    canvas.scene = canvas.scene | on_canvas
    canvas.path, canvas.error, canvas.message = points.tolist(), None, message

    def walk(change: dict[str, Any]) -> None:
        try:
            player, message = _along(follow, np.array(change["new"], float))
            canvas.show(player, **on_canvas, autoplay=True)
            canvas.error, canvas.message = None, message
        except Exception as error:  # of any kind: it comes from a student's function
            canvas.error, canvas.message = error, f"{type(error).__name__}: {error}"

    canvas.observe(walk, "path")
    return canvas


def _along(follow: Follow, path: Array) -> tuple[Player, str]:
    """Follow a path; return the player, and what stands below the canvas: its `alt`, and all warnings."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", MocapWarning)
        made = follow(path)
    player = made if isinstance(made, Player) else play(made)
    if not len(player.marks.path):
        player = replace(player, marks=player.marks._replace(path=path))
    return player, "\n".join([player.alt, *(str(warning.message) for warning in caught)])

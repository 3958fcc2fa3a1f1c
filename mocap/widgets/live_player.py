"""Players whose scene Python changes: a canvas to draw a path on, and sliders that mix."""

import warnings
from collections.abc import Callable
from dataclasses import replace
from time import monotonic
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, frozen
from mocap._shared.easing import quintic_step
from mocap.blending import mix
from mocap.blending.clocks import Registration, checked, require_registration
from mocap.body.motion import Motion
from mocap.errors import MocapWarning
from mocap.steering.layered_search import States
from mocap.steering.path_search import PathSearch, watching
from mocap.widgets.embedding import joined
from mocap.widgets.live import display_live
from mocap.widgets.player import Player, play
from mocap.widgets.shared_traits import AnyWidget, ipywidgets, shared

Follow = Callable[[Array], Motion | Player]
FPS = 30.0  # frames per second of a mix
TELL = 0.1  # seconds between two reports of the best walk so far
EASE = 0.4  # seconds until new weights are reached


class LivePlayer(AnyWidget):
    """A player whose scene Python changes, and which reports to Python the frame that it shows."""

    _esm = joined(*Player.scripts)
    scene = shared({"number": 0})
    at = shared([-1, 0])  # reads: name: the browser sets it: the number of a scene, and a frame
    move = shared([0, 0])  # Python sets it: the number of a scene, and a frame
    path = shared([])
    message = shared("")
    best = shared([])  # the line of the best walk so far, while a search is under way
    player: Player
    error: Exception | None = None
    reported = 0.0  # seconds by the clock, when the best walk so far was reported

    def show(self, player: Player, frame: int = 0, **extra: bool) -> None:
        """Show another player in the same position, from a frame on."""
        number = self.scene["number"] + 1
        # The browser gets the frame before the scene: a frame that comes later would stop the player.
        self.move = [number, frame]
        self.player = player
        self.scene = player.scene | extra | {"number": number}

    def watch(self, search: PathSearch, walks: States) -> None:
        """Report to the browser the best walk so far of a search that is under way."""
        if monotonic() > self.reported + TELL:
            line = search.line(walks)
            self.reported = monotonic()
            self.best = np.stack([line.imag, line.real], axis=-1).round(2).tolist()

    @property
    def frame(self) -> int:
        """The frame of this scene that the browser reported last, or that Python set."""
        number, frame = self.at
        if number != self.scene["number"]:
            _, frame = self.move
        return int(frame)

    def __repr__(self) -> str:
        return f"LivePlayer({self.player.alt!r})"

    def _ipython_display_(self) -> None:
        display_live(self.player._repr_mimebundle_(), self)


def draw_path(follow: Follow, path: ArrayLike) -> LivePlayer:
    """Show a canvas on which the reader draws a path, and a walk along it.

    Parameters
    ----------
    follow : called with a path, shape (N, 2), points (x, z) in metres; returns a motion, or a `play` of one.
        Its `alt`, which can give the walk's distance from the path, and all warnings are shown below the
        canvas. While a `steering.follow_path` in it searches, the best walk so far is drawn.
        Its `path`, if it has one, is drawn instead of the reader's line: use it for the path that was
        followed, such as a spline.
    path : the first path, shape (N, 2).

    Returns
    -------
    A live player; its `path` is the reader's last line, its `error` the exception of `follow` there, or None.

    Raises
    ------
    MocapError : if anywidget is not installed.
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
    canvas = LivePlayer()

    def redraw(change: dict[str, Any]) -> None:
        line = np.array(change["new"], float)
        is_first = not change["old"]
        canvas.best = []
        canvas.error = None
        token = watching.set(canvas.watch)
        try:
            with warnings.catch_warnings(record=True, action="always", category=MocapWarning) as caught:
                walk = follow(line)
            player = walk if isinstance(walk, Player) else play(walk)
            if not len(player.path):
                player = replace(player, path=line)
            canvas.show(player, drawable=True, follow=False, reports=False, autoplay=not is_first)
            canvas.message = "\n".join([player.alt, *(str(warning.message) for warning in caught)])
        except Exception as error:  # of any kind: it comes from a student's function
            canvas.error = error
            canvas.message = f"{type(error).__name__}: {error}"
        finally:
            watching.reset(token)

    canvas.observe(redraw, "path")
    canvas.path = np.reshape(np.asarray(path, float), (-1, 2)).tolist()
    if canvas.error:
        raise canvas.error
    return canvas


class Mixer:
    """A player of a blend, and a slider for each clip; when a slider moves, the rest of the blend changes.

    The frames that have been played do not change. From the frame that is shown, the weights ease to those of
    the sliders. (To steer a blend in this way while it plays is one of the uses that [KG03] names.)

    Parameters
    ----------
    registration : of C clips.
    weights : those at the start, shape (C,); by default all equal.

    Raises
    ------
    MocapError : for weights that do not add up to one, and if anywidget is not installed.

    Examples
    --------
    >>> from mocap.blending import register
    >>> from mocap.datasets import sample
    >>> slow, brisk = (sample(name) for name in ("walk_5m_0.8_0", "walk_5m_1.1_0"))
    >>> mixer = Mixer(register([slow, brisk]), [1, 0])
    >>> mixer.player.at = [mixer.player.scene["number"], 30]  # as the browser says where it is
    >>> mixer.sliders[0].value, mixer.sliders[1].value = 0.0, 1.0  # as a reader moves them
    >>> mixer.weights(0.0, 0.5).round(2), mixer.weights(0.0, 2.0).round(2)
    (array([1., 0.]), array([0., 1.]))

    Notebook: 15-registration
    """

    def __init__(self, registration: Registration, weights: ArrayLike = ()) -> None:
        count = len(require_registration(registration).clips)
        start = np.asarray(weights, float)
        if not start.size:
            start = np.full(count, 1 / count)
        start = checked(start, count)
        self.registration = registration
        self.start = frozen(start, np.float64)
        self.changes: list[tuple[float, Array]] = []  # new weights, and the blend's second when they begin
        self.player = LivePlayer()
        self.player.show(self._blend_player(), reports=True)
        self.sliders = []
        names = [clip.name for clip in registration.clips]
        for number, (name, value) in enumerate(zip(names, start, strict=True), 1):
            label = f"{name} {number}" if names.count(name) > 1 else name
            slider = ipywidgets.FloatSlider(value, min=0.0, max=1.0, step=0.05, description=label)
            slider.observe(self._take_weights, "value")
            self.sliders.append(slider)
        self.box = ipywidgets.VBox([*self.sliders, self.player])

    def weights(self, u: float, t: float) -> Array:
        """Return the weights at second t of the blend, as `blending.mix` asks for them."""
        mixed = np.array(self.start)
        for begin, weights in self.changes:
            mixed += float(quintic_step((t - begin) / EASE)) * (weights - mixed)
        return mixed

    def _blend_player(self) -> Player:
        """Return a player of the blend with its weights so far."""
        blend = mix(self.registration, self.weights, fps=FPS)
        return play(blend, alt="A blend whose weights sliders change.")

    def _take_weights(self, _change: dict[str, Any]) -> None:
        """Take the sliders' weights from the frame that is shown; all at 0 leave the weights as they were."""
        values = np.array([slider.value for slider in self.sliders])
        if not values.sum() > 0:
            return
        frame = self.player.frame
        self.changes = [change for change in self.changes if change[0] < frame / FPS]
        self.changes.append((frame / FPS, frozen(values / values.sum(), np.float64)))
        player = self._blend_player()
        self.player.show(player, min(frame, player.scene["frames"] - 1), reports=True, autoplay=True)

    def __repr__(self) -> str:
        return f"Mixer({len(self.sliders)} clips)"

    def _ipython_display_(self) -> None:
        display_live(self.player.player._repr_mimebundle_(), self.box)

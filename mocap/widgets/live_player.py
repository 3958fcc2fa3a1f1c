"""Players whose scene Python changes: a canvas on which a path is drawn, and sliders of blend weights."""

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
FPS = 30.0  # frames per second of a blend
REPORT_INTERVAL = 0.1  # seconds between two reports of the best walk so far
EASE = 0.4  # seconds until new weights are reached


class LivePlayer(AnyWidget):
    """A player whose scene Python changes, and which reports the current frame to Python."""

    _esm = joined(*Player.scripts)
    scene = shared({"number": 0})
    at = shared([-1, 0])  # reads: name: the browser sets it: the number of a scene, and a frame
    move = shared([0, 0])  # Python sets it: the number of a scene, and a frame
    path = shared([])
    message = shared("")
    best = shared([])  # the line of the best walk so far, during a search
    player: Player
    error: Exception | None = None
    reported = 0.0  # clock time of the last report of the best walk so far, seconds

    def show(self, player: Player, frame: int = 0, **extra: bool) -> None:
        """Replace the player, and continue at a frame."""
        number = self.scene["number"] + 1
        # The browser gets the frame before the scene, because a later frame would stop the player.
        self.move = [number, frame]
        self.player = player
        self.scene = player.scene | extra | {"number": number}

    def watch(self, search: PathSearch, walks: States) -> None:
        """Send the best walk so far of a running search to the browser."""
        if monotonic() > self.reported + REPORT_INTERVAL:
            line = search.line(walks)
            self.reported = monotonic()
            self.best = np.stack([line.imag, line.real], axis=-1).round(2).tolist()

    @property
    def frame(self) -> int:
        """The last frame of this scene that the browser reported or that Python set."""
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
    follow : called with a path, shape (N, 2), points (x, z) in metres. It returns a motion, or a `play` of a
        motion, whose `alt`, for example with the walk's distance from the path, is shown below the canvas,
        with all warnings. If it has a `path`, such as the spline that was followed, this is drawn instead of
        the reader's line. While `steering.follow_path` searches in this function, the best walk so far is
        drawn.
    path : the first path, shape (N, 2).

    Returns
    -------
    A live player, with the reader's last line as `path` and the exception of `follow`, or None, as `error`.

    Raises
    ------
    MocapError : if anywidget is not installed.
    Exception : any exception of `follow` for the first path. Later, the canvas shows the error.

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
        except Exception as error:  # any exception, because a student's function raises it
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
    """A player of a blend with a slider for the weight of each clip, which changes the rest of the blend.

    The frames that have been played do not change. After the current frame, the weights ease to those of the
    sliders. Such interactive control of a blend is one of the applications in [KG03].

    Parameters
    ----------
    registration : the registration of C clips.
    weights : the initial weights, shape (C,), by default all equal.

    Raises
    ------
    MocapError : for weights that do not add up to one, and if anywidget is not installed.

    Examples
    --------
    >>> from mocap.blending import register
    >>> from mocap.datasets import sample
    >>> slow, brisk = (sample(name) for name in ("walk_5m_0.8_0", "walk_5m_1.1_0"))
    >>> mixer = Mixer(register([slow, brisk]), [1, 0])
    >>> mixer.player.at = [mixer.player.scene["number"], 30]  # as the browser reports its frame
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
        self.changes: list[tuple[float, Array]] = []  # times of the blend, seconds, and weights from then
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
        """Return the weights at time t of the blend, seconds, as a callback of `blending.mix`."""
        mixed = np.array(self.start)
        for begin, weights in self.changes:
            mixed += float(quintic_step((t - begin) / EASE)) * (weights - mixed)
        return mixed

    def _blend_player(self) -> Player:
        """Return a player of the blend with its weights so far."""
        blend = mix(self.registration, self.weights, fps=FPS)
        return play(blend, alt="A blend whose weights sliders change.")

    def _take_weights(self, _change: dict[str, Any]) -> None:
        """Apply the sliders' weights after the current frame, unless all of them are 0."""
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

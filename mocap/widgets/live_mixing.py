"""Sliders that change a blend's weights while it plays: continuous control by registration curves."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, frozen
from mocap._shared.easing import quintic_step
from mocap.blending.clocks import checked
from mocap.blending.mixing import mix
from mocap.blending.registering import Registration
from mocap.errors import MocapError
from mocap.widgets.live import display_live
from mocap.widgets.live_player import linked
from mocap.widgets.player import play

FPS = 30.0  # of the blend that is shown


class Change(NamedTuple):
    """New weights: from `time` on, in the blend's seconds, they come in over the ease."""

    time: float
    weights: Array


class Mixer:
    """A player of a blend, and a slider for each clip; where a slider moves, the rest of the blend changes.

    What has been played stays as it was. From the frame that is shown, the weights ease to what the sliders
    say. (That a blend may be steered so while it plays is one of the uses that [KG03] names.)

    Parameters
    ----------
    registration : of C clips.
    weights : those at the start, shape (C,); by default all alike.
    ease : seconds until new weights are reached.

    Raises
    ------
    MocapError : for weights that do not add up to one, an ease that is not above 0, and where anywidget is
        not installed.

    Examples
    --------
    >>> from mocap.blending import register
    >>> from mocap.datasets import sample
    >>> slow, brisk = (sample(name) for name in ("walk_5m_0.8_0", "walk_5m_1.1_0"))
    >>> mixer = Mixer(register([slow, brisk]), [1, 0])
    >>> mixer.player.frame = 30
    >>> mixer.sliders[0].value, mixer.sliders[1].value = 0.0, 1.0  # as a reader moves them
    >>> mixer.weights(0.0, 0.5).round(2), mixer.weights(0.0, 2.0).round(2)
    (array([1., 0.]), array([0., 1.]))

    Notebook: 15-registration
    """

    def __init__(self, registration: Registration, weights: ArrayLike = (), *, ease: float = 0.4) -> None:
        import ipywidgets

        if not (np.isfinite(ease) and ease > 0):
            raise MocapError(f"New weights need more than 0 s to come in, got {ease} s.")
        count = len(registration.clips)
        given = np.asarray(weights, float)
        start = checked(given if given.size else np.full(count, 1 / count), count)
        self.registration, self.ease, self.start = registration, ease, frozen(start, np.float64)
        self.changes: list[Change] = []
        self.player = linked(self._played())
        self.sliders = [
            ipywidgets.FloatSlider(value, min=0.0, max=1.0, step=0.05, description=self._name(number))
            for number, value in enumerate(start)
        ]
        for slider in self.sliders:
            slider.observe(self._moved, "value")
        self.box = ipywidgets.VBox([*self.sliders, self.player])

    def weights(self, u: float, t: float) -> Array:
        """Give the weights at second t of the blend, as `mix` asks for them."""
        now = np.array(self.start)
        for change in self.changes:
            now += float(quintic_step((t - change.time) / self.ease)) * (change.weights - now)
        return now

    def _name(self, number: int) -> str:
        name = self.registration.clips[number].name
        twins = [clip.name for clip in self.registration.clips].count(name) > 1
        return f"{name} {number + 1}" if twins else name

    def _played(self) -> Any:  # noqa: ANN401
        return play(
            mix(self.registration, self.weights, fps=FPS), alt="A blend whose weights sliders change."
        )

    def _moved(self, _change: dict[str, Any]) -> None:
        """Take the sliders' weights from the frame that is shown; all at 0 leave the weights as they were."""
        values = np.array([slider.value for slider in self.sliders])
        if not values.sum() > 0:
            return
        frame = self.player.frame
        self.changes = [change for change in self.changes if change.time < frame / FPS]
        self.changes.append(Change(frame / FPS, frozen(values / values.sum(), np.float64)))
        played = self._played()
        frame = min(frame, played.scene["frames"] - 1)
        # The browser is to know the place before the scene: a place that comes later would stop the player.
        self.player.move = [self.player.scene["number"] + 1, frame]
        self.player.show(played, reports=True, autoplay=True)
        with self.player.silent():
            self.player.frame = frame

    def __repr__(self) -> str:
        return f"Mixer({len(self.sliders)} clips)"

    def _ipython_display_(self) -> None:
        display_live(self.player.player._repr_mimebundle_(), self.box)

"""Live widgets: what a cell shows of them, and what is said where anywidget is missing."""

import importlib
import sys

import pytest
from matplotlib.figure import Figure

from mocap.blending import register
from mocap.errors import MocapError
from mocap.widgets import Mixer, draw_path, explore, steered
from mocap.widgets.live import LIVE, STILL, WIDGET
from tests.blending.registered import walks
from tests.strategies import wave
from tests.widgets.steerable import Dot

pytest.importorskip("anywidget")

MADE = {
    "experiment": lambda: explore(lambda n: Figure(figsize=(2, 2)), alt="Nothing at all.", n=(0, 9)),
    "player": lambda: draw_path(lambda path: wave(30), [[0, 0], [0, 1]]),
    "mixer": lambda: Mixer(register([walks()[1.1, 120], walks()[1.1, -120]])),
    "steered": lambda: steered({"dot": Dot()}),
}


@pytest.mark.parametrize("kind", MADE)
def test_a_cell_shows_what_stays_with_its_sentence_and_then_the_live_widget(kind, monkeypatch):
    shown = []
    monkeypatch.setattr("IPython.display.display", lambda data, **options: shown.append((data, options)))
    made = MADE[kind]()
    made._ipython_display_()
    (data, options), (widget, _) = shown
    assert set(data) == {"image/png", "text/html", "text/plain"} and STILL in data["text/html"]
    assert data["text/plain"] == options["metadata"]["image/png"]["alt"]
    assert set(widget) == {WIDGET}
    assert LIVE in getattr(made, "box", made)._dom_classes


@pytest.mark.parametrize("kind", ["live_player", "pointing", "steered_widget"])
def test_without_anywidget_one_sentence_says_what_to_install(kind, monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    for name in ("shared_traits", "live_player", "pointing", "steered_widget"):
        monkeypatch.delitem(sys.modules, f"mocap.widgets.{name}")
    with pytest.raises(MocapError, match=r"needs anywidget: pip install '\.\[notebooks\]'"):
        importlib.import_module(f"mocap.widgets.{kind}")

"""The functions that the exercises of notebooks 01 to 08 ask for, as a motion graph uses them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import SimpleNamespace
from typing import Any

from mocap.course.checks import all_checks
from mocap.course.lab.adopting import slots
from mocap.course.lab.guarding import Slot

NAMES = (
    "climb",
    "window_sums",
    "inner_minima",
    "best_angle",
    "best_shift",
    "undo",
    "choice_points",
    "successors_of",
    "tarjan",
    "component_to_keep",
    "lay_on",
    "edge_cost",
    "lengthen",
    "survivors",
    "product_of",
    "hamilton",
    "move_points",
    "quintic",
    "short_way",
    "mix",
    "next_edge",
)
"""The exercises in the order in which a motion graph needs them."""


class Tools(SimpleNamespace):
    """A function for each of `NAMES`, as `tools.climb` and so on.

    Examples
    --------
    >>> packages().quintic(4).round(3).tolist()
    [0.896, 0.5, 0.104, 0.0]
    """

    def __getattr__(self, name: str) -> Callable[..., Any]:
        raise AttributeError(f"No step of a motion graph asks for '{name}'.")


def tools() -> Tools:
    """Take the student's functions, where they passed their checks, and the package's for the rest.

    Notebook: 08b-steering
    """
    return Tools(**{slot.name: slot for slot in slots(*NAMES)})


def packages() -> Tools:
    """Take the package's functions alone."""
    return Tools(**{name: Slot(all_checks()[name]) for name in NAMES})


def replaced(some: Tools, by: Mapping[str, Callable[..., Any]]) -> Tools:
    """Put other functions into some places, as tests and experiments do."""
    return Tools(**{**vars(some), **by})

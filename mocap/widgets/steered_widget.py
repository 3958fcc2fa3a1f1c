"""Pictures of steered characters in a notebook, the reader's command, and a recording for other pages.

The browser asks for the next frames when it has few left, and says the command; Python takes that many
steps and sends where the joints are. Nothing runs between two questions: no thread, and nothing to stop.
"""

from __future__ import annotations

import html
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from mocap.body.motion import Motion
from mocap.errors import MocapError, shortened
from mocap.plotting.style import ASTRAY, COLOURS, MARK, SOURCES
from mocap.steering.characters import Character
from mocap.steering.steered_motion import as_motion
from mocap.widgets.company import Company, Member, Order, Walked
from mocap.widgets.embedding import PAGE, PICTURE, SCENE, TOUCH, joined
from mocap.widgets.player import SIDES, Player, play
from mocap.widgets.reopening import display_live

OWN = ("steered_walker.js", "steering_page.js", "steering.js")
RECORDED = ((0.0, 2.0), (math.pi / 2, 4.0), (-math.pi / 4, 4.0))  # headings, and seconds of each
APART = 1.5  # metres between two characters of the recording
MOST = 1.0  # seconds of one answer


def script() -> str:
    """Return what the widget runs."""
    return joined(SCENE, PICTURE, PAGE, TOUCH, *map(Path(__file__).with_name, OWN))


class _Steered:
    """The widget without its traits: it answers the browser, and records a walk for other pages."""

    company: Company
    still: tuple[dict[str, str], dict[str, Any]]
    alt: str
    command: list[Any]
    send: Any

    @property
    def delays(self) -> dict[str, list[float]]:
        """The seconds until each character obeyed, one for each command that it did not obey already."""
        return {member.name: list(member.clock.delays) for member in self.company.members}

    def answer(self, _: object, asked: dict[str, Any], __: object = None) -> None:
        """Answer a question of the browser: walk on, and send the frames; or say what is wrong with it."""
        try:
            heading, speed, label = asked["command"]
            order = Order(float(heading), float(speed), str(label)).checked()
            seconds = float(np.clip(float(asked["seconds"]), 0.0, MOST))
            if math.isnan(seconds):
                raise MocapError("Python was asked for nan seconds.")
        except (KeyError, TypeError, ValueError) as error:
            self.send({"kind": "refused", "why": shortened(f"{type(error).__name__}: {error}", 200)})
            return
        walked = self.company.walk(order, seconds)
        members = zip(self.company.members, walked, strict=True)
        self.send(
            {
                "kind": "walked",
                **{key: asked.get(key) for key in ("view", "number")},
                "cost": self.company.cost,
                "notes": self.company.notes,
                "members": [_told(member, frames) for member, frames in members],
            },
            buffers=[frames.places.astype("<f4").tobytes() for frames in walked],
        )

    def __repr__(self) -> str:
        return f"Steered({', '.join(member.name for member in self.company.members)})"

    def _ipython_display_(self) -> None:
        display_live(self.still, self)


def _told(member: Member, walked: Walked) -> dict[str, Any]:
    """Say of each frame what is not in the numbers of the joints."""
    return {
        "first": walked.first,
        "waited": [round(step.waited, 3) for step in walked.steps],
        "obeyed": [step.obeyed for step in walked.steps],
        "blending": [bool(step.pose.blending) for step in walked.steps],
        "fault": walked.fault,
        "delays": member.clock.delays[-20:],
    }


@cache
def _class() -> type[Any]:
    """Make the widget's class, once; it needs anywidget, which may not be installed."""
    try:
        import anywidget
        import traitlets
    except ImportError as error:
        raise MocapError("To steer in a page needs anywidget: pip install 'mocap[notebooks]'.") from error

    class LiveSteering(_Steered, anywidget.AnyWidget):
        """Pictures of characters, and a `command` that the reader and Python may set."""

        _esm = script()
        scene = traitlets.Dict().tag(sync=True)
        command: traitlets.List[Any] = traitlets.List([0.0, 1.1, ""]).tag(sync=True)

        @traitlets.validate("command")
        def _possible(self, proposal: dict[str, Any]) -> list[Any]:
            return list(Order(*proposal["value"]).checked())

    return LiveSteering


def steered(
    characters: Mapping[str, Character],
    *,
    speeds: tuple[float, float] = (0.5, 1.6),
    labels: Sequence[str] = (),
    record: bool = True,
    alt: str = "",
) -> Any:  # noqa: ANN401
    """Let the reader steer characters side by side: one command for all, by mouse, keys or touch.

    The command goes from the browser to Python and comes back as steps; the line below the pictures says how
    long this is under way, beside how long each character takes to obey. First, each character walks ten
    seconds that are recorded: two ahead, four to the left, four to the right. A notebook that is opened
    without Python plays them.

    Parameters
    ----------
    characters : one to four by name, anything with the members of `steering.Character`. They walk on from
        where they are.
    speeds : the least and the most that the reader can ask for, metres per second.
    labels : kinds of motion to choose from, as `step` takes them; "" stands for any.
    record : False shows a picture in place of the recording, for captured motion that is not to be stored.
    alt : a sentence for readers who do not see it; by default it gives the names.

    Returns
    -------
    A widget; a notebook shows it as the last line of a cell. Its `command` is [heading, speed, label], which
    Python may set; its `delays` has the seconds until each character obeyed, by name.

    Raises
    ------
    MocapError : as `Company`, for speeds that do not rise from 0 on, and where anywidget is not installed.

    Examples
    --------
    >>> from mocap import body, datasets, motion_matching
    >>> database = motion_matching.tabulate([body.resample(datasets.sample("walk_curve_1"), 30)])
    >>> page = steered({"matching": motion_matching.MotionMatcher(database)}, speeds=(0.6, 0.9))
    >>> page, [len(seconds) for seconds in page.delays.values()]
    (Steered(matching), [2])

    Notebook: 17-parametric-graphs
    """
    low, high = (float(speed) for speed in speeds)
    if not 0 <= low < high < math.inf:
        raise MocapError(f"Speeds to ask for rise from 0 on, got {low:g} to {high:g} m/s.")
    company, speed = Company(characters), min(max(1.1, low), high)
    alt = alt or f"Stick figures obey one command: {', '.join(member.name for member in company.members)}."
    player = play(*_recorded(company, speed), follow=False, alt=alt)
    widget = _class()(scene=_scene(company, alt) | {"speeds": [low, high], "labels": list(labels)})
    widget.command = [RECORDED[-1][0], speed, ""]
    widget.company, widget.alt, widget.still = company, alt, _still(player, record)
    widget.on_msg(widget.answer)
    return widget


def _recorded(company: Company, speed: float) -> list[Motion]:
    """Walk the recording, and put the characters side by side, the first at the left."""
    walks = [company.walk(Order(heading, speed), seconds) for heading, seconds in RECORDED]
    motions, count = [], len(company.members)
    for number, (member, parts) in enumerate(zip(company.members, zip(*walks, strict=True), strict=True)):
        poses = [step.pose for part in parts for step in part.steps]
        motion = as_motion(member.character, poses, member.name)
        away = np.array([number - (count - 1) / 2, 0, 0]) * APART - motion.root_positions[0] * [1, 0, 1]
        motions.append(replace(motion, root_positions=motion.root_positions + away))
    return motions


def _still(player: Player, record: bool) -> tuple[dict[str, str], dict[str, Any]]:
    """Give what a page without Python shows: the recording or its picture, and a sentence."""
    data, metadata = player._repr_mimebundle_()
    seen = data["text/html"] if record else player.still()._repr_mimebundle_()[0]["text/html"]
    said = "Recorded: ahead for 2 s, 4 s to the left, 4 s to the right. Run the cell to steer by yourself."
    data["text/html"] = f"<p>{html.escape(said)}</p>{seen}"
    return data, metadata


def _scene(company: Company, alt: str) -> dict[str, Any]:
    """Give what the scripts have to know beforehand."""
    members = [
        {
            "name": member.name,
            "fps": member.character.fps,
            "joints": len(member.limbs.joints),
            "bones": member.limbs.lines,
            "head": member.limbs.head,
            "colour": colour if len(company.members) > 1 else COLOURS["middle"],
        }
        for member, colour in zip(company.members, SOURCES, strict=False)
    ]
    return {
        "alt": alt,
        "members": members,
        "sides": [COLOURS[side] for side in SIDES],
        "marks": {"seam": MARK, "astray": ASTRAY},
    }

"""A notebook widget in which the reader steers characters, with a recording for pages without Python.

The browser requests the next frames when its buffer is nearly empty, and sends the command. Python takes as
many steps and returns the positions of the joints. Nothing runs between two requests, so there is no thread
to stop.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mocap.body.motion import Motion
from mocap.errors import MocapError, shortened
from mocap.plotting.style import COLOURS, own_colour
from mocap.steering.characters import Character, as_motion
from mocap.widgets.company import LONGEST_FAULT, Company, checked
from mocap.widgets.embedding import CANVAS, PAGE, PICTURE, SCENE, SHADED, TOUCH, joined
from mocap.widgets.live import display_live
from mocap.widgets.player import LOOK, play
from mocap.widgets.shared_traits import AnyWidget, shared, validate

OWN = ("steered_command.js", "steered_walker.js", "steering_page.js", "steering.js")
RECORDED = ((0.0, 2.0), (math.pi / 2, 4.0), (-math.pi / 4, 4.0))  # headings, radians, and their seconds
APART = 1.5  # metres between two characters of the recording
MOST = 1.0  # longest duration of one answer, seconds
USUAL_SPEED = 1.1  # metres per second of the recording, if it is within the range of speeds


class Steered(AnyWidget):
    """A widget with pictures of characters, and a `command` that the reader and Python may set."""

    _esm = joined(*SHADED, CANVAS, SCENE, PICTURE, PAGE, TOUCH, *map(Path(__file__).with_name, OWN))
    scene = shared({})
    command = shared([0.0, 1.1, ""])
    company: Company
    still: tuple[dict[str, str], dict[str, Any]]
    alt: str

    @validate("command")
    def _check(self, proposal: dict[str, Any]) -> list[Any]:
        """Return the command, or raise if no character accepts it."""
        return list(checked(*proposal["value"]))

    @property
    def delays(self) -> dict[str, list[float]]:
        """The delays of each character, seconds, one for each command that it did not already obey."""
        return {member.name: list(member.clock.delays) for member in self.company.members}

    def answer(self, _: object, request: dict[str, Any], __: object = None) -> None:
        """Answer a request of the browser with the next frames, or with an error."""
        try:
            order = checked(*request["command"])
            seconds = min(max(0.0, float(request["seconds"])), MOST)
        except (KeyError, TypeError, ValueError) as error:
            reason = shortened(f"{type(error).__name__}: {error}", LONGEST_FAULT)
            self.send({"kind": "refused", "why": reason})
            return
        walks = self.company.walk(order, seconds)
        reply = {"kind": "walked", "view": request.get("view"), "number": request.get("number")}
        reply |= {"cost": self.company.cost, "notes": self.company.notes}
        reply["members"] = [walked.report for walked in walks]
        self.send(reply, buffers=[walked.positions.astype("<f4").tobytes() for walked in walks])

    def __repr__(self) -> str:
        return f"Steered({', '.join(member.name for member in self.company.members)})"

    def _ipython_display_(self) -> None:
        display_live(self.still, self)


def steered(
    characters: Mapping[str, Character],
    *,
    speeds: tuple[float, float] = (0.5, 1.6),
    labels: Sequence[str] = (),
    turned: bool = True,
    alt: str = "",
) -> Steered:
    """Show characters side by side that the reader steers by one command, with mouse, keys or touch.

    The browser sends the command to Python, which returns steps. The line below the pictures shows the time
    of this exchange, and the delay until each character obeys. First, ten seconds of each character are
    recorded: two ahead, four to the left, and four to the right. A notebook that is opened without Python
    plays the recording.

    Parameters
    ----------
    characters : one to four characters by name, which implement `steering.Character`. They continue from
        their current positions.
    speeds : the lowest and the highest speed that the reader can request, metres per second.
    labels : kinds of motion to choose from, as arguments of `step`, where "" permits any.
    turned : whether characters on graphs and by motion matching are turned about their roots, with their
        standing feet held: they obey within a second, see `steering.RootTurner`. Others stay as they are.
    alt : a sentence for readers who do not see the widget. By default it contains the names.

    Returns
    -------
    A widget. A notebook shows it as the last line of a cell. Its `command` is [heading, speed, label], which
    Python may set. Its `delays` has the delays, seconds, of each character by name.

    Raises
    ------
    MocapError : as for `Company`, for speeds that are not 0 <= low < high, and if anywidget is not installed.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods import motion_matching
    >>> database = motion_matching.tabulate([body.resample(datasets.sample("walk_curve_1"), 30)])
    >>> page = steered({"matching": motion_matching.MotionMatcher(database)}, speeds=(0.6, 0.9))
    >>> page, [len(seconds) for seconds in page.delays.values()]
    (Steered(matching), [0])

    Notebook: 18-motion-matching
    """
    low, high = (float(speed) for speed in speeds)
    if not 0 <= low < high < math.inf:
        raise MocapError(f"Speeds to ask for rise from 0 on, got {low:g} to {high:g} m/s.")
    company = Company(characters, turned=turned)
    speed = min(max(USUAL_SPEED, low), high)
    names = ", ".join(member.name for member in company.members)
    alt = alt or f"Figures obey one command: {names}."
    data, metadata = play(*_recorded(company, speed), follow=False, alt=alt)._repr_mimebundle_()
    for member in company.members:
        member.clock.delays = []
        member.clock.counts = False  # the reader has not steered yet
    note = "Recorded: ahead for 2 s, 4 s to the left, 4 s to the right. Run the cell to steer by yourself."
    data["text/html"] = f"<p>{note}</p>{data['text/html']}"
    members = _packed_members(company)
    scene = {"alt": alt, "members": members, **LOOK, "speeds": [low, high], "labels": list(labels)}
    page = Steered(scene=scene)
    page.command = [RECORDED[-1][0], speed, ""]
    page.company = company
    page.alt = alt
    page.still = (data, metadata)
    page.on_msg(page.answer)
    return page


def _packed_members(company: Company) -> list[dict[str, Any]]:
    """Pack the names, the bodies and the colours of all characters for the browser."""
    members = []
    for number, member in enumerate(company.members):
        packed = {"name": member.name, "fps": member.character.fps, **member.body}
        packed["colour"] = own_colour(number, len(company.members)) or COLOURS["middle"]
        members.append(packed)
    return members


def _recorded(company: Company, speed: float) -> list[Motion]:
    """Return the motions of the recording, side by side, the first one on the left."""
    parts = [company.walk((heading, speed, ""), seconds) for heading, seconds in RECORDED]
    motions = []
    middle = (len(company.members) - 1) / 2
    for number, (member, walks) in enumerate(zip(company.members, zip(*parts, strict=True), strict=True)):
        poses = [pose for walked in walks for pose in walked.poses]
        motion = as_motion(member.character, poses, member.name)
        start = np.array([number - middle, 0, 0]) * APART
        translation = start - motion.root_positions[0] * [1, 0, 1]
        motions.append(replace(motion, root_positions=motion.root_positions + translation))
    return motions

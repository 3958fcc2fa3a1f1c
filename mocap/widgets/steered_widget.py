"""Pictures of steered characters in a notebook, the reader's command, and a recording for other pages.

The browser asks for the next frames when it has few left, and says the command; Python takes that many
steps and sends where the joints are. Nothing runs between two questions: no thread, and nothing to stop.
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
from mocap.widgets.company import Company, checked
from mocap.widgets.embedding import PAGE, PICTURE, SCENE, SHADED, TOUCH, joined
from mocap.widgets.live import display_live
from mocap.widgets.player import LOOK, play
from mocap.widgets.shared_traits import AnyWidget, shared, validate

OWN = ("steered_walker.js", "steering_page.js", "steering.js")
RECORDED = ((0.0, 2.0), (math.pi / 2, 4.0), (-math.pi / 4, 4.0))  # headings, and seconds of each
APART = 1.5  # metres between two characters of the recording
MOST = 1.0  # seconds of one answer


class Steered(AnyWidget):
    """Pictures of characters, and a `command` that the reader and Python may set."""

    _esm = joined(*SHADED, SCENE, PICTURE, PAGE, TOUCH, *map(Path(__file__).with_name, OWN))
    scene, command = shared({}), shared([0.0, 1.1, ""])
    company: Company
    still: tuple[dict[str, str], dict[str, Any]]
    alt: str

    @validate("command")
    def _check(self, proposal: dict[str, Any]) -> list[Any]:
        return list(checked(*proposal["value"]))

    @property
    def delays(self) -> dict[str, list[float]]:
        """The seconds until each character obeyed, one for each command that it did not obey already."""
        return {member.name: list(member.clock.delays) for member in self.company.members}

    def answer(self, _: object, asked: dict[str, Any], __: object = None) -> None:
        """Answer a question of the browser: walk on, and send the frames; or say what is wrong with it."""
        try:
            order = checked(*asked["command"])
            seconds = min(max(0.0, float(asked["seconds"])), MOST)
        except (KeyError, TypeError, ValueError) as error:
            self.send({"kind": "refused", "why": shortened(f"{type(error).__name__}: {error}", 200)})
            return
        walked = self.company.walk(order, seconds)
        self.send(
            {
                **{"kind": "walked", "view": asked.get("view"), "number": asked.get("number")},
                **{"cost": self.company.cost, "notes": self.company.notes},
                "members": [one.told for one in walked],
            },
            buffers=[one.places.astype("<f4").tobytes() for one in walked],
        )

    def __repr__(self) -> str:
        return f"Steered({', '.join(member.name for member in self.company.members)})"

    def _ipython_display_(self) -> None:
        display_live(self.still, self)


def steered(
    characters: Mapping[str, Character],
    *,
    speeds: tuple[float, float] = (0.5, 1.6),
    labels: Sequence[str] = (),
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
    alt : a sentence for readers who do not see it; by default it gives the names.

    Returns
    -------
    A widget; a notebook shows it as the last line of a cell. Its `command` is [heading, speed, label], which
    Python may set; its `delays` has the seconds until each character obeyed the reader, by name.

    Raises
    ------
    MocapError : as `Company`, for speeds that do not rise from 0 on, and where anywidget is not installed.

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
    company, speed = Company(characters), min(max(1.1, low), high)
    names = ", ".join(member.name for member in company.members)
    alt = alt or f"Figures obey one command: {names}."
    data, metadata = play(*_recorded(company, speed), follow=False, alt=alt)._repr_mimebundle_()
    for clock in (member.clock for member in company.members):
        clock.delays, clock.counts = [], False  # the reader has steered nothing yet
    said = "Recorded: ahead for 2 s, 4 s to the left, 4 s to the right. Run the cell to steer by yourself."
    data["text/html"] = f"<p>{said}</p>{data['text/html']}"
    members = [
        {
            **{"name": member.name, "fps": member.character.fps, **member.body},
            "colour": own_colour(number, len(company.members)) or COLOURS["middle"],
        }
        for number, member in enumerate(company.members)
    ]
    scene = {"alt": alt, "members": members, **LOOK, "speeds": [low, high], "labels": list(labels)}
    page = Steered(scene=scene)
    page.command = [RECORDED[-1][0], speed, ""]
    page.company, page.alt, page.still = company, alt, (data, metadata)
    page.on_msg(page.answer)
    return page


def _recorded(company: Company, speed: float) -> list[Motion]:
    """Walk the recording, and put the characters side by side, the first at the left."""
    walks = [company.walk((heading, speed, ""), seconds) for heading, seconds in RECORDED]
    motions, count = [], len(company.members)
    for number, (member, parts) in enumerate(zip(company.members, zip(*walks, strict=True), strict=True)):
        poses = [pose for part in parts for pose in part.poses]
        motion = as_motion(member.character, poses, member.name)
        away = np.array([number - (count - 1) / 2, 0, 0]) * APART - motion.root_positions[0] * [1, 0, 1]
        motions.append(replace(motion, root_positions=motion.root_positions + away))
    return motions

"""A character that turns about the foot that stands, as much as it is asked to turn and its clips do not.

A motion graph turns only where its clips turn. But a figure that is turned as a whole about a foot that
stands does not slide: that foot pivots in its place, the other one is in the air, and the walk goes on in the
new direction. So here the figure is turned in each frame by a little more, towards what is asked. All of
this is ours; the papers change the motion afterwards [Gle01], when the whole path is known.
"""

import cmath
import math
from collections import deque

import numpy as np

from mocap._shared.arrays import Points
from mocap.body.planar import on_ground
from mocap.errors import MocapError
from mocap.steering.characters import Pose
from mocap.steering.graph_control import Controller

# Radians. At 40° per second no stance is turned by more than 25°: a foot stands for a frame before its joints
# are slow. Without a bound stances turn by up to 29°, and the character obeys 0.05 s sooner.
MOST = np.radians(24)

# Radians. As long as the direction is off by more, the figure turns at its full rate; below, the rate falls
# with the square. The pelvis sways, and the direction with it, by about 6° to both sides: to turn against
# that would wag the whole figure.
FULL = np.radians(20)

# Metres per second on the ground. A faster joint is in the air: what its stance was turned by is forgotten.
# With 0.3 it counts as in the air while it still stands, and stances turn by up to 30°.
STANDING = 0.5

# Seconds in which the rate rises, from 0 where the pivot goes over to the other foot: there the root, which
# turned to one side about a foot behind it, turns to the other about one ahead. Without it the root's
# accelerations double. To let the pivot glide over instead would slide both feet.
EASE = 0.1
APART = 0.25  # metres: a pivot that moves further has gone over to the other foot

# Metres per second. A slower character goes nowhere, so it has no direction that could be wrong.
WALKING = 0.15


class FootTurner:
    """A character, turned in each frame by a little more about the foot that stands, towards the command.

    The direction of the last third of a second is off the heading by e. Before each frame the figure
    turns towards it, by rate · min(1, e² / (20°)²) / fps, about the slowest of its ankles and balls. A joint
    that stands is turned by 24° at most; then the figure waits until that foot is in the air. The rate rises
    over 0.1 s, and begins anew where the other foot becomes the slowest.

    Parameters
    ----------
    character : what gives the poses; its figure is turned while it walks.
    rate : radians per second to turn at most; 0 leaves the character as it is.

    Raises
    ------
    MocapError : for a rate that is below 0 or no finite number.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> from mocap.steering import Controller, measure_delay
    >>> clips = [body.resample(datasets.sample("walk_circle"), 30)]
    >>> graph = graphs.compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> alone = measure_delay(Controller(graph), turns=10).mean
    >>> alone - measure_delay(FootTurner(Controller(graph)), turns=10).mean > 0.3
    True

    Notebook: 18-motion-matching
    """

    def __init__(self, character: Controller, rate: float = np.radians(40)) -> None:
        if not 0 <= rate < np.inf:
            raise MocapError(f"A figure turns by a finite rate from 0 on, got {rate} radians per second.")
        self.character, self.rate = character, rate
        self.skeleton, self.fps = character.skeleton, character.fps
        # The root's way on the ground in the last third of a second, as it would be without any turn, and the
        # turn so far: so what was turned shows at once. If it showed only as the walk goes on, the figure
        # would turn too far and back, for ever: a straight walk would wag by 18°.
        self.track: deque[complex] = deque(maxlen=round(character.fps / 3) + 1)
        self.last, self.turn = 0j, 1 + 0j
        self.feet: Points = np.zeros(4, complex)
        self.pivot = 0j  # the foot that stands
        self.angle = 0.0  # by which the last frame was turned, radians
        self.turned = np.zeros(4)  # by how much each foot was turned since it stands, radians

    @property
    def frames_left(self) -> int:
        """The frames until the character's next choice; it turns before that, too."""
        return self.character.frames_left

    def step(self, heading: float, speed: float, label: str = "") -> Pose:
        """Turn a little about the foot that stands, then walk on by one frame as `Controller.step` does."""
        if len(self.track) > 1:
            self._turn(heading)
        pose = self.character.step(heading, speed, label)
        root = complex(on_ground(pose.root_position))
        self.track.append(self.track[-1] + (root - self.last) / self.turn if self.track else 0j)
        self.last = root
        # The slowest of the feet's joints is the pivot, and the turns of those in the air are forgotten.
        feet = self.character.feet()
        moved = np.abs(feet - (self.feet if len(self.track) > 1 else feet))
        self.turned[moved > STANDING / self.fps] = 0
        pivot = complex(feet[moved.round(6).argmin()])  # all of a flat foot stands: then the ankle
        if abs(pivot - self.pivot) > APART:
            self.angle = 0.0
        self.feet, self.pivot = feet, pivot
        return pose

    def _turn(self, heading: float) -> None:
        """Turn towards the heading, as far as the rate and the stances allow."""
        way = self.turn * (self.track[-1] - self.track[0])  # in the last third of a second
        stands = abs(way) * self.fps < WALKING * (len(self.track) - 1)
        missing = 0.0 if stands else cmath.phase(cmath.exp(1j * heading) / way)
        most = self.rate / self.fps * min(1.0, (missing / FULL) ** 2)
        least, largest = min(0.0, -MOST - self.turned.min()), max(0.0, MOST - self.turned.max())
        rise = self.rate / (EASE * self.fps**2)
        angle = max(self.angle - rise, min(self.angle + rise, math.copysign(most, missing)))
        self.angle = angle = max(least, min(largest, angle))
        more = cmath.exp(1j * angle)
        self.character.turn_about(self.pivot, angle)
        self.turn *= more / abs(self.turn)
        self.feet = self.pivot + more * (self.feet - self.pivot)
        self.last = self.pivot + more * (self.last - self.pivot)
        self.turned += angle

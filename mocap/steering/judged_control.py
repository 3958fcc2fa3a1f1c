"""One protocol for all characters: how soon they obey, how feet slide, what jolts, what a step costs."""

import warnings
from collections.abc import Callable

import numpy as np

from mocap._shared.arrays import Array, runs
from mocap._shared.records import NamedTuple
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.planar import on_ground
from mocap.errors import MocapError, MocapWarning
from mocap.feet.footskate import clean_up
from mocap.quality.seam_measures import USUAL, Spread, foot_sliding, jumps, mean_foot_sliding
from mocap.steering.characters import Character, Delay, measure_delay, steer

TURNS = np.radians([30, 120])  # of a command
EVERY = 2.0  # seconds


class ControlReport(NamedTuple):
    """The measures of a character by one protocol; `judge_control` shows an example.

    `delay` is as `measure_delay` gives it. `slide` is how far a planted joint strays from its mean place, cm,
    on average over plants, and `cleaned` the same after `feet.clean_up`, which kept the share `kept` of the
    planted frames. `jolting` is the share of frames whose velocity jumps further than 99.9 % of the clips'
    own. `wags` is by how many degrees the direction swings while a command stands, the RMS. `pivots` is by
    how many degrees a foot turns while it stands, on average over plants, and `pace` the speed in m/s.
    """

    delay: Delay
    slide: float
    cleaned: float
    kept: float
    jolting: float
    wags: float
    pivots: float
    pace: float


def command_headings(seconds: float, fps: float, seed: int = 0) -> Array:
    """Draw commands: every two seconds a turn by 30 to 120 degrees to either side, one heading per frame.

    Examples
    --------
    >>> command_headings(4, 30).shape
    (120,)

    Notebook: 18-motion-matching
    """
    random = np.random.default_rng(seed)
    count = int(np.ceil(seconds / EVERY))
    turns = random.choice([-1, 1], count) * random.uniform(TURNS[0], TURNS[1], count)
    return np.repeat(np.cumsum(turns), round(EVERY * fps))[: round(seconds * fps)]


def judge_control(
    make: Callable[[], Character], usual: Spread, *, speed: float = 1.1, seconds: float = 60.0, seed: int = 0
) -> ControlReport:
    """Judge a character by the same commands as all others.

    Plants are those of the clips that frames come from, carried along: plants found anew would hide the
    fault, because a foot that slides is no plant.

    Parameters
    ----------
    make : makes the character anew, on clips whose plants are marked; it is called twice.
    usual : `quality.spread` of its clips.
    speed : metres per second of all commands.
    seconds : of steering, for feet and jolts.
    seed : of the commands.

    Raises
    ------
    MocapError : for a character whose clips do not say when feet stand.

    Examples
    --------
    >>> from mocap import body, datasets, graphs, quality
    >>> from mocap.steering import Controller
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> report = judge_control(lambda: Controller(graph), quality.spread(clips), seconds=20)
    >>> bool(report.slide > report.cleaned), report.kept > 0.9
    (True, True)

    Notebook: 18-motion-matching
    """
    character = make()
    headings = command_headings(seconds, character.fps, seed)
    motion = steer(character, headings.tolist(), speed).motion
    if not any(mark.any() for mark in motion.contacts.values()):
        raise MocapError("The character's clips do not say when feet stand; mark_plants finds out.")
    with warnings.catch_warnings(action="ignore", category=MocapWarning):  # how much was let go is `kept`
        cleaned = clean_up(motion)
    limit = np.percentile(usual.within(1), USUAL)
    steps = np.abs(np.diff(on_ground(motion.root_positions)))
    delay = measure_delay(make(), speed=speed, seed=seed)
    slides = (_mean_slide(motion), _mean_slide(cleaned))
    kept = _planted_frames(cleaned) / _planted_frames(motion)
    jolting = float((jumps(motion) > limit).mean())
    pace = float(steps.mean() * motion.fps)
    return ControlReport(delay, *slides, kept, jolting, _wags(motion, headings), _pivots(motion), pace)


def _planted_frames(motion: Motion) -> int:
    """Count the frames in which joints are planted, over all joints."""
    return sum(int(mark.sum()) for mark in motion.contacts.values())


def _mean_slide(motion: Motion) -> float:
    """Average the slides of planted joints. Plants of two frames are too short to slide."""
    return mean_foot_sliding(slide for slide in foot_sliding(motion) if slide.stop - slide.start > 2)


def _wags(motion: Motion, headings: Array) -> float:
    """Measure how the direction swings in the last half second of each command, degrees."""
    back = round(motion.fps / 3)
    half = round(motion.fps / 2)
    interval = round(EVERY * motion.fps)
    track = on_ground(motion.root_positions)
    directions = np.angle(track[back:] - track[:-back])
    ends = np.arange(interval, len(headings) + 1, interval)
    frames = ends[:, None] - back + np.arange(-half, 0)  # (commands, frames of half a second)
    variances = np.var(np.unwrap(directions[frames]), axis=1)
    return float(np.degrees(np.sqrt(variances.mean())))


def _pivots(motion: Motion) -> float:
    """Average by how many degrees feet turn on the ground, from ankle to ball, while their ankles stand."""
    positions = joint_positions(motion)
    pivots = []
    for leg in find_legs(motion.skeleton):
        directions = np.angle(on_ground(positions[:, leg.ball] - positions[:, leg.ankle]))
        ankle = motion.skeleton.names[leg.ankle]
        for start, stop in runs(motion.contacts[ankle]):
            if stop - start > 2:
                pivots.append(np.ptp(np.unwrap(directions[start:stop])))
    return float(np.degrees(np.mean(pivots))) if pivots else 0.0

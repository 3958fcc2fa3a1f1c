"""A character on a motion graph that a page steers, and the poses of its last minutes, for recordings.

Each request of the page has the current command, and is answered by the next frames. The character obeys as
`steering.RootTurner` describes, with its standing feet held.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.motion import Motion
from mocap.body.planar import on_ground
from mocap.errors import MocapError
from mocap.feet.footplants import mark_plants
from mocap.graphs.motion_graph import MotionGraph
from mocap.plotting.style import COLOURS
from mocap.steering.characters import Pose, as_motion
from mocap.steering.graph_control import Controller
from mocap.steering.root_turning import STRETCH, WALKING
from mocap.widgets.company import Company, checked
from mocap.widgets.player import LOOK

LONGEST_ANSWER = 1.0  # seconds of one answer
LONGEST_RECORDING = 300.0  # seconds
SHORTEST_RECORDING = 3  # frames
LATE = 2.0  # seconds of poses that are kept beyond the longest recording, for requests that arrive late
PERCENTILES = (5, 50, 95)  # of the speeds of the clips: the lowest, the usual and the highest to ask for
STEP = 20  # steps of the speed per m/s


class SteeredSession:
    """A character on a motion graph that is steered piece by piece, with a memory of its last minutes.

    Parameters
    ----------
    graph : a pruned graph. Clips without contacts are marked, so that standing feet can be held.
    labels : the kinds of motion to choose from. The first is that of the start, and the second that of the
        faster pace. By default these are any kind, and the one with the fastest clips.

    Raises
    ------
    NoWalk : for a label that no clip has.
    MocapError : for clips whose legs are not found.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> session = SteeredSession(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> reply = session.walk({"seconds": 0.5, "command": [0.0, 0.9, ""]})
    >>> reply["first"], len(reply["positions"])
    (1, 15)
    >>> session.record({"first": 1, "last": 12})
    Motion('steered', 12 frames at 30 Hz, 0.367 s, 38 joints)
    """

    def __init__(self, graph: MotionGraph, labels: Sequence[str] = ()) -> None:
        graph = replace(graph, clips=tuple(_marked(clip) for clip in graph.clips))
        controller = Controller(graph)
        for label in labels:
            controller.graph.label_number(label)  # raises for an unknown one
        self.company = Company({"steered": controller})
        self.member = self.company.members[0]
        self.fps = self.member.character.fps
        self.poses: deque[Pose] = deque(maxlen=round((LONGEST_RECORDING + LATE) * self.fps))
        self.lock = threading.Lock()  # a page may send its next request before the last one is answered
        self.labels = list(labels) or ["", *sorted({label for clip in graph.clips for label in clip.labels})]
        self.speeds = _speeds(graph.clips)
        self.pace_of = _speeds_by_label(graph.clips, self.labels, self.speeds)
        self.second = labels[1] if len(labels) > 1 else max(self.pace_of, key=self.pace_of.__getitem__)

    def scene(self) -> dict[str, Any]:
        """Return what the page has to know: the body, the colours, the kinds of motion and the speeds."""
        body = {"name": "steered", "fps": self.fps, **self.member.body, "colour": COLOURS["middle"]}
        low, _, high = np.percentile(self.speeds, PERCENTILES)
        speeds = [_in_steps(low * (1 - STRETCH)), _in_steps(high * (1 + STRETCH))]
        fast = [self.second, self.pace_of[self.second]]
        if self.second == self.labels[0]:
            fast[1] = speeds[1]
        scene: dict[str, Any] = {"member": body, **LOOK, "labels": self.labels, "speeds": speeds}
        scene |= {"paces": self.pace_of, "fast": fast, "stands": bool(self.speeds.min() < WALKING)}
        return scene | {"longest": LONGEST_RECORDING}

    def walk(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """Walk on, and return the next frames: the positions of the drawn joints, metres, and a report.

        Parameters
        ----------
        request : the `seconds` to walk, and the `command`: heading in radians, speed in m/s, and a label.

        Raises
        ------
        MocapError : for a request of another form, and a command that no character accepts.
        """
        try:
            order = checked(*request["command"])
            seconds = float(request["seconds"])
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            raise MocapError("A request has the seconds to walk, and a command of three values.") from error
        if not 0 <= seconds <= LONGEST_ANSWER:
            raise MocapError(f"An answer lasts from 0 to {LONGEST_ANSWER:g} s, got {seconds}.")
        if order[1] > 2 * self.speeds.max() + 1:
            raise MocapError(f"No clip is as fast as {order[1]:g} m/s.")
        with self.lock:
            (walked,) = self.company.walk(order, seconds)
            self.poses.extend(walked.poses)
            notes = self.company.notes
        positions = walked.positions.reshape(len(walked.poses), -1).round(4).tolist()
        return {**walked.report, "positions": positions, "notes": notes}

    def record(self, request: Mapping[str, Any]) -> Motion:
        """Return the motion from a first to a last frame, numbered as in the answers of `walk`.

        Raises
        ------
        MocapError : for frames that were not walked, or are too old, and for too few or too many of them.
        """
        try:
            first = int(request["first"])
            last = int(request["last"])
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            raise MocapError("A recording has the numbers of its first and its last frame.") from error
        with self.lock:
            oldest = self.member.steps - len(self.poses)
            if not oldest <= first <= last < self.member.steps:
                end = self.member.steps - 1
                raise MocapError(f"Frames {oldest} to {end} can be recorded, got {first} to {last}.")
            poses = list(islice(self.poses, first - oldest, last + 1 - oldest))
        if not SHORTEST_RECORDING <= len(poses) <= LONGEST_RECORDING * self.fps + 1:
            lengths = f"{SHORTEST_RECORDING} frames to {LONGEST_RECORDING:g} s"
            raise MocapError(f"A recording lasts from {lengths}, got {len(poses)} frames.")
        return as_motion(self.member.character, poses)


def _marked(clip: Motion) -> Motion:
    """Return a clip with contacts, found from its motion if it has none."""
    return clip if clip.contacts else mark_plants(clip)


def _speeds(clips: Sequence[Motion]) -> Array:
    """Return the speeds of clips on the ground, in m/s, each over a second, or over a shorter clip."""
    return np.concatenate([_speeds_of(clip) for clip in clips])


def _speeds_of(clip: Motion) -> Array:
    """Return the speeds of a clip over the seconds that begin with its frames."""
    frames = min(round(clip.fps), len(clip) - 1)
    track = on_ground(clip.root_positions)
    return np.asarray(np.abs(track[frames:] - track[:-frames]) * clip.fps / frames)


def _speeds_by_label(clips: Sequence[Motion], labels: Sequence[str], speeds: Array) -> dict[str, float]:
    """Return the median speed of each kind of motion, m/s. That of any kind, "", is of all moving frames."""
    moving = speeds[speeds > WALKING]
    usual = float(np.median(moving if len(moving) else speeds))
    return {label: _in_steps(_speed_of(label, clips, usual)) for label in labels}


def _speed_of(label: str, clips: Sequence[Motion], usual: float) -> float:
    """Return the median speed of the frames with a label, or the usual speed if there are none."""
    of_label = [np.zeros(0)]
    for clip in clips:
        if label in clip.labels:
            speeds = _speeds_of(clip)
            of_label.append(speeds[clip.labels[label][: len(speeds)]])
    speeds_of_label = np.concatenate(of_label)
    return float(np.median(speeds_of_label)) if len(speeds_of_label) else usual


def _in_steps(speed: float) -> float:
    """Round a speed to the steps of the page's slider."""
    return round(STEP * float(speed)) / STEP

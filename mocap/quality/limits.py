"""Limits that captured people keep, chosen by trials; `figures/tune/quality.py` runs the trials again.

Those of `inspect` were checked on 132 trials of the CMU database at 120 Hz, of subjects 02, 03, 16, 49 and
127. The limits of hips, wrists and the neck are those of [AAOS65], in `joint_limits`.
"""

from __future__ import annotations

import math

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Limits:
    """Each limit with its unit, and the reason for its value."""

    # Flaws of a clip, as `inspect` reports them
    frozen: int = 3  # frames in a row that repeat the one before. Two trials have 6 and 13, the others none
    teleport: float = 5.0  # m/s of the root. The fastest runs reach 5.5
    # Above `teleport` no root reaches more than 1.4 times the median, except in one trial: 17 times. Below, a
    # body that stands and starts to move reaches 26 times.
    sudden: float = 5.0  # times the median speed of the neighbouring frames
    sudden_frames: int = 5  # neighbouring frames on either side. With 1 no leap is found
    # 99.99 % of all rotations stay below 31° per frame. Of the 28 trials with a rotation above 45°, 16 have
    # one above 150°, which no joint can do in a frame.
    snap: float = math.pi / 4  # radians per frame
    # At 30 Hz, 45° per frame is only 24 radians per second, and joints of trials without a snap reach 36.
    fast: float = 50.0  # radians per second
    # A motion that starts from its rest pose has a first step like the next ones. With a rest pose before 28
    # clips of people, at 30 and 120 Hz, the step out of it is at least 6.4 times their median.
    rest_leap: float = 3.0  # times the median sum of joint rotations in the neighbouring frames
    flip: float = 2.0  # change of an Euler angle, times the joint's rotation. In a snap they are equal
    # The sole of a shoe is about as thick, and markers are less exact: the lowest joint of subject 16 is 2 cm
    # under the floor, those of the others up to 9 cm.
    under: float = 0.03  # metres
    smallest: float = 0.15  # metres of height. A wrong unit of length is likelier than a body so small
    tallest: float = 3.5  # metres of height. The same for a body so tall

    # Jumps of velocity. At 30 Hz, in the walks, runs and jumps of CMU's subject 16, leaps have 20 times the
    # percentile `LEAP_PERCENTILE` of all frames, and all other frames but one at most 3.3 times.
    leap: float = 5.0  # times that percentile. Above it a jump is a leap in the data
    seam_jolt: float = 1.5  # times the percentile `USUAL` of the windows of the clips

    # Measures of a motion, as `judge` explains them. They were chosen on 99 clips of CMU's subjects 02, 16
    # and 49, of the homework and of Bandai-Namco, at their own rate and at 30 Hz, and checked on 54 of eight
    # other sources. Clips with leaps in their data do not count: eight of the former and six of the latter.
    jolt: float = 5.5  # times the usual jump nearby. Clips reach 5.0; a step aside by 10 cm has 7.4 or more
    jolt_floor: float = 0.1  # m/s. Of usual jumps, the smallest to compare with: a body that stands has less
    jolt_ceiling: float = 0.4  # m/s. The largest to compare with: a hop has 0.4, more is a clip full of leaps
    # At their own rate, at 60 and at 30 Hz, clips without leaps in their data reach 3.9.
    cut: float = 4.2  # times the usual jump of the pose nearby. A cut of 42 ms has more in 95 % of 130 clips
    cut_floor: float = 0.006  # metres. The smallest to compare with: a body that stands has less
    cut_ceiling: float = 0.02  # metres. The largest to compare with: at 30 Hz, runs have 0.02
    tremble: float = 4.0  # mm, median over the frames. Runs reach 3.1, and a tremor of 15 mm has 7.9 or more
    # Kicks and rolls reach 10.6 in two clips, the others 6.0. A hip or a knee that is rotated by 23° within
    # 1/30 s has 6 or more in 99 % of 115 clips.
    snap_ratio: float = 6.0  # times the usual leap nearby
    snap_floor: float = 1.0  # radians per second. The smallest to compare with: a walker's thigh has less
    snap_ceiling: float = 1.5  # radians per second. The largest to compare with: a runner's shank has 1.5
    still: float = 0.02  # m/s, root mean square over the joints. People who stand sway at about this speed
    halting: float = 0.2  # m/s before or after a frozen stretch. With 0.1, a standing person counts as frozen
    standstill: float = 0.15  # seconds of a frozen stretch. Two clips with repeated frames have 0.05
    slip: float = 12.0  # percent of the body's speed. People reach 8; on a path 1.3 times too long 18 or more
    foot_sliding: float = 2.5  # cm, mean over the footplants
    sliding_speed: float = 12.0  # percent of the body's speed. Someone who hops reaches 11, others 8
    toes: float = 5.0  # cm. Toes that push off reach 3.4, and on the level floors of other sources 4.9
    # Hands that carry the body reach 4.3, feet 2.2, and in other sources 5.7, where the floor is lower.
    sunk: float = 5.0  # cm. A body is lower for a moment in more clips than for a tenth of a second
    aloft: float = 25.0  # cm. In 153 clips the lowest joint comes down to 12.5 cm or lower, also on stairs
    lopsided: float = 20.0  # mm
    bones: float = 5.0  # mm
    rotation: float = 2000.0  # degrees per second, within 1/30 s. The fastest foot reaches 1960
    path: float = 15.0  # cm, mean over the frames; `steering.follow_path` warns above it
    shortest: float = 0.75  # metres, of a body that walks. A grown one in inches, read as cm, is 0.7 at most
    longest: float = 2.5  # metres

    # Knees and elbows
    backwards: float = 10.0  # degrees that they may bend backwards
    folded: float = 160.0  # degrees that they may bend forwards
    about_one_axis: float = 0.5  # cosine between a knee's axis and the hips', to tell that it bends backwards
    # Arms with elbows that bend by 12° in the median have 0.22 or more, and those with 4° at most 0.05.
    sure_bend: float = 0.1  # mean sine of an elbow's bending about its axis, to tell what is backwards


LIMITS = Limits()

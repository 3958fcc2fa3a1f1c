"""Constants of the clean-up that trials chose; `figures/tune/feet.py` runs the trials again."""

from __future__ import annotations

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    # Weights of corrections, each of a metre; the knee's angle counts as metres on a quarter of the leg
    root: float = 3.0  # weight of the root's rise. At 1 the root trembles more, at 6 knees snap
    list: float = 5.0  # weight of a hip's height by the list of the pelvis. At 10 more knees snap
    knee: float = 2.0  # weight of the knee's position. 1 to 4 are as good on walks
    foot: float = 4.0  # weight of the ankle's position. At 1.5 the root trembles more
    angle: float = 10.0  # weight of the knee's angle. At 3 knees snap by twice as much
    bent: float = 100.0  # weight of the angle by which a knee is too straight. At 30 straight legs jolt
    closed: float = 1000.0  # weight of the gap between leg and ankle. 100 to 3000 are as good

    # Durations in which corrections fade
    fade: float = 0.075  # seconds, of the root, knees and ankles. At 0.05 the root trembles more
    list_fade: float = 0.025  # seconds. At 0.04 pelvises list more, at 0.01 standing bodies tremble
    angle_fade: float = 0.06  # seconds, of a knee's angle. At 0.24 the ends of a motion change more

    # Corrections of a foot in the air
    swing_fade: float = 0.06  # seconds. At 0.02 the ankles of runs accelerate more; 0.1 holds as many frames
    fade_frames: float = 2.5  # at least, for a fade. At 0 ankles at 30 Hz accelerate more

    # Positions of plants
    flexion: float = 12.0  # degrees: no knee becomes straighter. At 8 straight legs jolt; 15 holds as much
    fall: float = 0.0167  # of the leg's length, by which the root may fall for a plant that is out of reach
    pulls: int = 4  # at most, of a plant into reach. 8 holds as many frames
    move: float = 0.5  # of the way to its foot that a plant moves. At 0.25 slow walks accelerate more
    falls: float = 0.9  # factor of the worst excess; if moves gain less, they end

    # Plants that cannot be held
    blame: float = 0.1  # seconds before and after an excess, in which plants may be the reason for it
    released: float = 0.5  # fraction of a plant's largest deviation, above which frames are released

    steps: int = 20  # at most, of Gauss-Newton. 10 to 40 are as good on walks
    gain: float = 1e-3  # fraction of the cost; a step that gains less is the last one. 1e-4 takes longer


TUNED = Tuned()

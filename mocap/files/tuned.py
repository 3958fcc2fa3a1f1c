"""Constants of files that trials chose; `figures/tune/files.py` runs the trials again."""

from __future__ import annotations

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    # Bones that change their length in a file
    stretch: float = 0.02  # metres. A bone whose length changes by more is no bone
    strayed: float = 2.5  # times the stretch: a joint's distance from its position in the file, at most
    rotation_weight: float = 1e-3  # λ, as a fraction of the bones' squared lengths. At 0 joints twist by 180°

    # The evidence of a clip's space. Lengths are fractions of the body's size
    least_joints: int = 8  # fewer joints make no body
    looked_at_rate: float = 30.0  # Hz. At 10 steps are too few frames to repeat
    looked_at_frames: int = 300  # ten seconds, in which a person takes some steps
    moving_speed: float = 0.02  # per second. If all joints are slower, a joint at rest shows nothing
    sideways_travel: float = 0.5  # a body that travels further along an axis does not stand along it
    mirrored_bones: float = 0.1  # relative difference of the bones of two limbs
    carried_length: float = 0.1  # how much farther one hand must reach than the other. Fingers differ by less
    frames_of_props: int = 30  # that show which limbs are mirror images
    airborne: float = 0.03  # height above the floor of the lowest joint in a jump
    air_frames: int = 6  # frames of a jump. Fewer show no parabola
    air_time: tuple[float, float] = (0.12, 1.2)  # seconds of a jump
    parabola_error: float = 0.004  # of the centre in free fall. On an uneven floor it is larger
    fall_acceleration: tuple[float, float] = (2.0, 40.0)  # per s², of bodies of 5 to 0.2 m
    least_seconds: float = 1.2  # a shorter clip shows no cycle of a gait
    shortest_cycle: float = 0.35  # seconds. Runs have cycles of 0.6
    longest_cycle: float = 2.5  # seconds. Slow walks have cycles of 1.6
    repeated_pose: float = 0.3  # change of the pose after a cycle, over the largest change before

    # The decision on the unit and the vertical axis. Errors of clocks are logarithms
    adult_height: tuple[float, float] = (1.55, 0.12)  # metres, and the spread of the logarithm
    sure_height: tuple[float, float] = (1.2, 1.9)  # metres. With 2.0 a toddler in feet is a sure man
    likely_height: tuple[float, float] = (1.2, 2.1)  # metres that another unit must give to be mentioned
    person_height: tuple[float, float] = (0.6, 2.3)  # metres. Other heights are mentioned
    default_height: tuple[float, float] = (0.1, 10.0)  # metres that the default unit may give
    sure_unit: float = 0.96  # probability. With 0.8 a child may be blown up without a word
    probable_unit: float = 0.84  # probability from which on the best unit is taken, and stated
    common_units: tuple[float, ...] = (1.0, 0.01, 0.001)  # metres. These need no clock
    confirming_clock: float = 0.45  # largest error of a clock that confirms an uncommon unit
    refuting_clock: float = 0.9  # smallest error of a clock that refutes a unit
    clock_weight: float = 3.0  # most that a clock may speak against a unit. Some falls are none
    sure_axis: float = 1.0  # lead of the best axis over the next
    probable_axis: float = 2.0  # lead from which on the best axis of a body on the floor is taken, and stated
    same_body: float = 1.5  # ratio of the bones of two files from which on they differ in the unit or by age
    still_foot: float = 0.4  # how much slower the lowest joint is than the others, as a logarithm to base 10

    # Positions of the root that are relative to its offset. Heights are fractions of the body's size
    root_height: float = 0.25  # least height of an offset that may be added. Hips are at 0.5 to 0.6
    floor_error: float = 0.1  # height of the lowest joint above or below the floor. Ankles are at 0.06

    # Rotations in a .glb
    carried: float = 0.25  # metres. A joint with a shorter limb below is rounded to 16 bits, 8 µm at its end


TUNED = Tuned()

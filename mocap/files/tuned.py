"""Constants of files that trials chose; `figures/tune/files.py` runs the trials again."""

from __future__ import annotations

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    # Bones that change their length in a file
    stretch: float = 0.02  # metres; a bone whose length changes by more is no bone
    strayed: float = 2.5  # times the stretch: a joint's distance from its position in the file, at most
    rotation_weight: float = 1e-3  # λ, as a fraction of the bones' squared lengths; at 0 joints twist by 180°

    # Files with z up
    along_z: float = 0.8  # fraction of a leg's length along z; at 0.99 files with z up are not found
    upright: float = 0.5  # fraction of the frames in which both legs are along z; a body may also lie or sit

    # Rotations in a .glb
    carried: float = 0.25  # metres; a joint with a shorter limb below is rounded to 16 bits, 8 µm at its end


TUNED = Tuned()

"""What a motion file says, besides the motion: its own angles, and by how much its bones stretch."""

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body.motion import Motion


class Recording(NamedTuple):
    """A `motion` as it was read, named after its file.

    angles : of each joint, shape (F, its axes), degrees, as they are in the file; an `.npz` has none.
    stretch : by how much the bone from its parent to each joint changes its length in the file, metres: the
        longest less the shortest. Only a `.bvh` file can have such bones.
    """

    motion: Motion
    angles: dict[str, Array]
    stretch: dict[str, float]

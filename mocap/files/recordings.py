"""The content of a motion file: the motion, the angles in the file, and the stretch of its bones."""

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body.motion import Motion


class Recording(NamedTuple):
    """The content of a motion file, whose `motion` is named after the file.

    angles : the angles of each joint in the file, shape (F, number of axes), degrees; an `.npz` has none.
    stretch : for each joint, the longest minus the shortest length of the bone from its parent in the file,
        metres. Only bones of a `.bvh` file can stretch.
    """

    motion: Motion
    angles: dict[str, Array]
    stretch: dict[str, float]

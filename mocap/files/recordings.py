"""The content of a motion file: the motion, the angles in the file, and the stretch of its bones."""

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body.motion import Motion
from mocap.errors import Remedy
from mocap.files.space_evidence import Evidence
from mocap.files.spaces import Space


class Recording(NamedTuple):
    """The content of a motion file, whose `motion` is named after the file.

    angles : the angles of each joint in the file, shape (F, number of axes), degrees. An `.npz` has none.
    stretch : for each joint, the longest minus the shortest length of the bone from its parent in the file,
        metres. Only bones of a `.bvh` file can stretch.
    space : the unit and the vertical axis that it was read in; None if the format says both.
    evidence : of the space; None if the format or the caller says it, or the joints make no body.
    has_roles : whether the file says the roles of joints, or that there are none, so that none are searched.
    assumed : what the file does not say, such as its frame rate, as a phrase that ends with a remedy for it.
    """

    motion: Motion
    angles: dict[str, Array]
    stretch: dict[str, float]
    assumed: Remedy | None = None
    space: Space | None = None
    evidence: Evidence | None = None
    has_roles: bool = False

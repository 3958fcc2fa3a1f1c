"""The content of a motion file: the motion, the angles in the file, and the stretch of its bones."""

from collections.abc import Mapping

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body.motion import Motion
from mocap.errors import Remedy, shortened
from mocap.files.space_evidence import Evidence
from mocap.files.spaces import Space


class Recording(NamedTuple):
    """The content of a motion file, whose `motion` is named after the file.

    angles : the angles of each joint in the file, shape (F, number of axes), degrees. An `.npz` has none.
    stretch : for each joint, the longest minus the shortest length of the bone from its parent in the file,
        metres. Only bones of a `.bvh` file can stretch.
    space : the unit and the vertical axis that it was read in; None if the format says both.
    evidence : of the space; None if the format or the caller says it, or the joints make no body.
    bodies : the names of the roots of all bodies in a `.bvh` file of which the first was read by default.
    has_roles : whether the file says the roles of joints, or that there are none, so that none are searched.
    assumed : what the file does not say, such as its frame rate, as a phrase that ends with a remedy for it.
    """

    motion: Motion
    angles: dict[str, Array]
    stretch: dict[str, float]
    assumed: Remedy | None = None
    space: Space | None = None
    evidence: Evidence | None = None
    bodies: tuple[str, ...] = ()
    has_roles: bool = False

    def notices(self, names: Mapping[str, str]) -> list[str]:
        """State what was decided or chosen by default, and the parameters that overrule it.

        Parameters
        ----------
        names : of the parameters of `files.load` on the surface that is used.
        """
        space = self.space.sentence(names) if self.space else ""
        return [notice for notice in (space, self.body_notice(names)) if notice]

    def body_notice(self, names: Mapping[str, str]) -> str:
        """State that the first of several bodies was read by default; "" if there is only one.

        Parameters
        ----------
        names : as for `notices`.
        """
        if len(self.bodies) < 2:
            return ""
        listed = shortened(", ".join(f"'{name}'" for name in self.bodies), 60)
        count = f"{len(self.bodies)} bodies with the roots {listed}"
        return f"{count}: the first one is read. {names['body']} chooses another."

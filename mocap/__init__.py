"""New human motion out of captured motion: matching, transforms, blending, motion graphs, synthesis.

Conventions, everywhere: y is up, the ground is the plane y = 0; metres, seconds, radians; column vectors;
quaternions are (w, x, y, z); a body whose heading is 0 faces +z, with its left at +x. Units are converted
where a file is read or written, and nowhere else.

Reading order
-------------
The numbers are those of the notebooks that tell of them. What motion is (01, 03): `skeleton`, `motion`,
`rotations`, `kinematics`, `transforms`. Where it comes from (01, 10): `acclaim`, `bvh`, `files`,
`inspection`, `synthetic`, `cmu`, `datasets`. What the course is about (02, 05, 06): `point_clouds`,
`cloud_grid`, `matching`, `minima`, `transitions`, `blending`, `segment_graph`, `motion_graph`, `pruning`,
`thresholds`, `merging`, `graph_summary`, `graph_files`. Out of the graph (07, 08): `walks`, `synthesis`,
`dumping`, `search`, `paths`, `routes`, `compiling`, `layered_search`, `follow`, `paper_search`, `keyframes`,
`crowd`, `control`. Seams and feet (04, 09): `joining`, `quality`, `legs`, `plants`, `leg_posing`,
`foot_targets`, `root_rise`, `calm_knees`, `footskate`; what once went wrong (03): `homework_slips`. What one
sees (00): `stage`, `stills`, `plotting`, `search_drawing`, `player`, `pointing`, `widgets`, `demo`. The
course itself: `checking`, `checks`, `course`, `handout`, `course_site`.

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
.. [KSG02] L. Kovar, J. Schreiner, M. Gleicher, *Footskate Cleanup for Motion Capture Editing*, SCA 2002,
   doi 10.1145/545261.545277.
.. [Bol18] D. Bollo, *Inertialization: High-Performance Animation Transitions in Gears of War*, GDC 2018.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mocap.errors import FormatError, MocapError, MocapWarning, NoWalk, SkeletonMismatch
    from mocap.files import load, load_skeleton, save
    from mocap.motion import Motion, concatenate, resample
    from mocap.skeleton import Skeleton
    from mocap.transforms import PlanarTransform

__version__ = "0.1.0"

# Each name is imported when it is first used, so that `import mocap` costs next to nothing.
_HOMES = {
    "FormatError": "errors",
    "MocapError": "errors",
    "MocapWarning": "errors",
    "NoWalk": "errors",
    "SkeletonMismatch": "errors",
    "load": "files",
    "load_skeleton": "files",
    "save": "files",
    "Motion": "motion",
    "concatenate": "motion",
    "resample": "motion",
    "Skeleton": "skeleton",
    "PlanarTransform": "transforms",
}

__all__ = [
    "FormatError",
    "MocapError",
    "MocapWarning",
    "Motion",
    "NoWalk",
    "PlanarTransform",
    "Skeleton",
    "SkeletonMismatch",
    "concatenate",
    "load",
    "load_skeleton",
    "resample",
    "save",
]


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module 'mocap' has no attribute '{name}'")
    return getattr(import_module(f"mocap.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return [*__all__, "__version__"]

"""New human motion out of captured motion: matching, transforms, blending, motion graphs, synthesis.

Conventions, everywhere: y is up, the ground is the plane y = 0; metres, seconds, radians; column vectors;
quaternions are (w, x, y, z); a body whose heading is 0 faces +z, with its left at +x. Units are converted
where a file is read or written, and nowhere else.

Rooms
-----
From the ground floor up, with the notebooks that teach them. A room uses only rooms on floors below its own;
for example `help(mocap.graphs)` lists its files in reading order.

body        what a moving body is: skeletons, motions, rotations, kinematics (01, 03)
files       where motion comes from and goes to: ASF/AMC, BVH, paths (01, 10)
matching    which moments are alike? distance grids and transitions (02, 05)
feet        feet that stand: footplants, footskate clean-up (04)
datasets    clips to begin with: bundled ones, the CMU database (01, 10)
blending    from one motion into another: blends, inertialization (04)
quality     numbers that judge clips and seams (01, 04, 10)
graphs      motion graphs, their pruning, thresholds and files (05, 06)
synthesis   out of the graph: random walks, search, motions (07)
steering    a walk where one wants it: paths, waypoints, crowds, control (08)
plotting    pictures, by matplotlib (00 to 10)
widgets     players and experiments for notebooks (00 to 10)
course      the notebooks as data, and the checks of their exercises
cli         the command `mocap`
"""

import lazy_loader

__version__ = "0.1.0"

# Each name is imported when it is first used, so that `import mocap` costs next to nothing.
__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submodules=[
        "blending",
        "body",
        "course",
        "datasets",
        "feet",
        "files",
        "graphs",
        "matching",
        "plotting",
        "quality",
        "steering",
        "synthesis",
        "widgets",
    ],
    submod_attrs={
        "errors": ["FormatError", "MocapError", "MocapWarning", "NoWalk", "SkeletonMismatch"],
        "body.skeleton": ["Skeleton"],
        "body.motion": ["Motion", "concatenate", "resample"],
        "body.planar": ["PlanarTransform"],
        "files.load_save": ["load", "load_skeleton", "save"],
    },
)

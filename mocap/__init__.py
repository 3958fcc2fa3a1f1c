"""New human motion out of captured motion: matching, blending, motion graphs, synthesis, steering.

Load clips, build a motion graph of them, and walk through it:

>>> import mocap
>>> from mocap import datasets, graphs, synthesis
>>> clip = mocap.resample(datasets.sample("walk_circle"), 30)
>>> graph = graphs.prune(graphs.build([clip], window=10, threshold=0.04))  # frames, metres
>>> walk = synthesis.to_motion(graph, synthesis.random_walk(graph, seconds=2, seed=1))
>>> walk.duration > 1.9
True

Conventions, everywhere: y points up, and the ground is the plane y = 0. Units are metres, seconds and
radians. Vectors are columns, quaternions are (w, x, y, z). A body with heading 0 faces +z and has its left at
+x. Files in other units are converted when they are read or written, and nowhere else.

Rooms
-----
The rooms of the package, from the ground floor up, with the notebooks that teach them. A room uses only rooms
on lower floors. `help(mocap.graphs)`, for example, lists the files of a room in reading order.

body               what a moving body is: skeletons, motions, rotations, kinematics (01, 03)
formats            the formats of motion files: ASF/AMC, BVH, AMASS .npz, glTF (01)
files              motion files by their suffix, whole folders of them; paths from CSV and SVG (01, 10)
matching           which moments are alike: metrics, distance grids, transitions (02, 05, 15)
feet               feet that stand still: footplants, footskate clean-up (04)
blending           from one motion into another: blends, inertialization, registration (04, 15)
quality            numbers that judge clips and seams (01, 04, 09 to 11)
editing            the motion itself changed: keys, pins, paths, other bodies (11 to 14)
datasets           clips to start with: bundled ones, the CMU database (01, 10, 11)
variants           more clips out of one: its mirror image, the cycle in it (10)
graphs             motion graphs: build, prune, choose a threshold, save (05, 06)
match_webs         all motions like an example, and spaces of blends between them (16)
synthesis          walks through a graph, at random or by search, and their motions (07)
steering           walks that follow a wish: paths, waypoints, crowds (08, 12)
control            characters that get a new command in any frame (08, 12, 17, 18)
plotting           pictures, by matplotlib (00 to 19)
parametric_graphs  graphs of whole spaces of strides, and characters that need no search (17)
motion_matching    characters without a graph: the frame that fits best, searched again and again (18)
groups             a crowd that was planned: group graphs, and characters for their members (19)
diagrams           ideas drawn step by step (00 to 09)
widgets            players and experiments for notebooks (00 to 19)
course             the notebooks: checks of exercises, hand-outs, pages
marking            marks for notebooks handed in, whose code runs sealed
teaching           slides and films that are made from the notebooks
lab                what students wrote is used, and what they thought is kept (00 to 19)
cli                the command `mocap`

Below them are `mocap.errors`, all errors that the package raises on purpose, and small helpers in `_shared`.

Where something new goes
------------------------
- A metric: a function with the signature of `matching.Metric`, in a file of `matching`.
- A file format: a reader and a writer in a file of `formats`; `files.load_save` chooses them by the suffix.
- A way of steering: a file of `steering`; most of them give `follow_path` a path and some wishes. One that
  reacts frame by frame: a class that fits `control.Character`, in a file of `control`.
- A method of its own kind: a room of its own, on the lowest floor that is above all it uses.

A room's `__init__.py` lists its files and exports its public names; the tests of a room are in `tests/ROOM`.
"""

import lazy_loader

__version__ = "0.1.0"

# Each name is imported at its first use, so that `import mocap` is quick.
__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submodules=[
        "blending",
        "body",
        "control",
        "course",
        "datasets",
        "diagrams",
        "editing",
        "feet",
        "files",
        "formats",
        "graphs",
        "groups",
        "lab",
        "marking",
        "match_webs",
        "matching",
        "motion_matching",
        "parametric_graphs",
        "plotting",
        "quality",
        "steering",
        "synthesis",
        "teaching",
        "variants",
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

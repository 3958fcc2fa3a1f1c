"""Synthesis of human motion from captured motion: matching, blending, motion graphs, search, steering.

Load clips, build a motion graph of them, and synthesise a random walk:

>>> import mocap
>>> from mocap import datasets, graphs, synthesis
>>> clip = mocap.resample(datasets.sample("walk_circle"), 30)
>>> graph = graphs.prune(graphs.build([clip], window=10, threshold=0.04))  # frames, metres
>>> walk = synthesis.to_motion(graph, synthesis.random_walk(graph, seconds=2, seed=1))
>>> walk.duration > 1.9
True

Conventions of the whole package: y points up, and the ground is the plane y = 0. Units are metres, seconds
and radians. Vectors are columns, quaternions are (w, x, y, z). A body with heading 0 faces +z, and +x is on
its left. Files in other units are converted only when they are read or written.

`mocap.plain` implements motion graphs in one short file: read it first. Its functions have fast equivalents
in the rooms.

Rooms
-----
The rooms of the package, from the ground floor up, with the notebooks that teach them. A room imports only
from rooms on lower floors. `help(mocap.graphs)`, for example, lists the files of a room in reading order.

body       skeletons, motions, rotations, forward kinematics (01, 03)
files      motion files: ASF/AMC, BVH, AMASS .npz, glTF, whole folders, paths from CSV and SVG (01, 10)
matching   similarity of motions: metrics, distance grids, transitions (02, 05, 15)
feet       footplants, footskate clean-up (04)
blending   transitions and blends: windows, inertialization, registration (04, 15)
quality    measures of clips and seams (01, 04, 09 to 11)
editing    editing of motions: keys, constraints, paths, mirror images, retargeting (10 to 14)
datasets   bundled clips, the CMU database, other datasets (01, 10, 11)
graphs     motion graphs: build, prune, choose a threshold, save (05, 06)
synthesis  walks through a graph, at random or by search, and their motions (07)
steering   walks along paths, and characters with a new command in any frame (08, 12, 17, 18)
methods    match webs, parametric graphs, motion matching, group graphs, in-betweens (16 to 19)
plotting   figures, by matplotlib (00 to 19)
widgets    players and experiments for notebooks (00 to 19)
course     the notebooks: checks of exercises, marks, pages, slides, the laboratory
cli        the command `mocap`

Below them are `mocap.errors`, the errors that the package raises, and utilities in `_shared`.

Extensions
----------
- A metric: a function with the signature of `matching.other_metrics.Metric`, in a file of `matching`.
- A file format: a reader and a writer in a file of `files`; `files.load_save` chooses them by the suffix.
- A method of steering: a file of `steering`; most of them call `follow_path` with a path and requests. If it
  reacts in each frame, a class that implements `steering.Character`, in a file of `steering`.
- Another method: a room in `methods`.

A room's `__init__.py` lists its files, and its `__init__.pyi` the names that it exports. Its tests are in
`tests/ROOM`.
"""

from mocap._shared import faces

__version__ = "0.2.0"

# Each name is imported at its first use, so that `import mocap` is quick; `__init__.pyi` lists them.
__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

"""Synthesis of human motion from captured motion: matching, blending, motion graphs, search, steering.

Load clips, build a motion graph, and synthesise a random walk:

>>> import mocap
>>> from mocap import datasets, graphs, synthesis
>>> clip = mocap.resample(datasets.sample("walk_circle"), 30)
>>> graph = graphs.prune(graphs.build([clip], window=10, threshold=0.04))  # frames, metres
>>> walk = synthesis.to_motion(graph, synthesis.random_walk(graph, seconds=2, seed=1))
>>> walk.duration > 1.9
True

Conventions: y points up, and the ground is the plane y = 0. Units are metres, seconds and radians. Vectors
are columns, and quaternions are (w, x, y, z). A body with heading 0 faces +z, and its left is +x. Files in
other units are converted only when they are read or written.

`mocap.plain` is a short implementation of motion graphs: read it first. Its functions have fast equivalents
in the rooms.

Rooms
-----
The rooms of the package, from the lowest layer up, with the notebooks that teach them. A room uses only rooms
in lower layers. `help(mocap.graphs)`, for example, lists the files of a room in reading order.

body       the model of a moving body: skeletons, motions, rotations, kinematics (01, 03)
files      motion files: ASF/AMC, BVH, AMASS .npz, glTF, CSV, and paths from CSV and SVG (01, 10)
matching   similarity of frames: metrics, distance grids, transitions (02, 05, 15)
feet       foot contacts: footplants, footskate clean-up (04)
blending   transitions between motions: blends, inertialization, registration (04, 15)
quality    measures of clips, seams and motions (01, 04, 09 to 11)
editing    changes of a motion: keys, constraints, paths, mirror images, retargeting (10 to 14)
datasets   clips to start with: bundled clips, the CMU database, named sets (01, 10, 11)
graphs     motion graphs: build, prune, choose a threshold, save (05, 06)
synthesis  walks through a graph, at random or by search, and their motions (07)
steering   walks along paths, and characters that obey commands in each frame (08, 12, 17, 18)
methods    match webs, parametric graphs, motion matching, group graphs, in-betweens (16 to 19)
plotting   plots with matplotlib (00 to 19)
widgets    players and experiments for notebooks (00 to 19)
course     the notebooks: checks of exercises, marks, pages, slides, the laboratory
cli        the command `mocap`

Below them are `mocap.errors`, with all errors that the package raises on purpose, and shared functions in
`_shared`.

Extending the package
---------------------
- A metric: a function with the signature of `matching.other_metrics.Metric`, in a file of `matching`.
- A file format: a reader and a writer in a file of `files`. `files.load_save` selects them by the suffix.
- A kind of steering: a file of `steering`. Most of them pass a path and requests to `follow_path`. Control in
  each frame is a class that implements `steering.Character`, in a file of `steering`.
- An independent method: a new room in `methods`.

A room's `__init__.py` lists its files, and its `__init__.pyi` the names that it exports. Its tests are in
`tests/ROOM`.
"""

from mocap._shared import faces, renamed

__version__ = "0.2.0"

# Each name is imported at its first use, so that `import mocap` is fast. `__init__.pyi` lists them.
renamed.name_old_modules()  # `import mocap.lab` says where the laboratory is now
__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

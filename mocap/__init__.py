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

`mocap.plain` is motion graphs on a few pages: read it first. Its functions have quick twins in the rooms.

Rooms
-----
The rooms of the package, from the ground floor up, with the notebooks that teach them. A room uses only rooms
on lower floors. `help(mocap.graphs)`, for example, lists the files of a room in reading order.

body       what a moving body is: skeletons, motions, rotations, kinematics (01, 03)
files      motion files: ASF/AMC, BVH, AMASS .npz, glTF, whole folders; paths from CSV and SVG (01, 10)
matching   which moments are alike: metrics, distance grids, transitions (02, 05, 15)
feet       feet that stand still: footplants, footskate clean-up (04)
blending   from one motion into another: blends, inertialization, registration (04, 15)
quality    numbers that judge clips and seams (01, 04, 09 to 11)
editing    the motion itself changed: keys, pins, paths, mirror images, other bodies (10 to 14)
datasets   clips to start with: bundled ones, the CMU database (01, 10, 11)
graphs     motion graphs: build, prune, choose a threshold, save (05, 06)
synthesis  walks through a graph, at random or by search, and their motions (07)
steering   walks that follow a wish, and characters that get a new command in any frame (08, 12, 17, 18)
methods    match webs, parametric graphs, motion matching, group graphs, in-betweens (16 to 19)
plotting   pictures, by matplotlib (00 to 19)
widgets    players and experiments for notebooks (00 to 19)
course     the notebooks: checks of exercises, marks, pages, slides, the laboratory
cli        the command `mocap`

Below them are `mocap.errors`, all errors that the package raises on purpose, and small helpers in `_shared`.

Where something new goes
------------------------
- A metric: a function with the signature of `matching.other_metrics.Metric`, in a file of `matching`.
- A file format: a reader and a writer in a file of `files`; `files.load_save` chooses them by the suffix.
- A way of steering: a file of `steering`; most of them give `follow_path` a path and some wishes. One that
  reacts frame by frame: a class that fits `steering.Character`, in a file of `steering`.
- A method of its own kind: a room of its own in `methods`.

A room's `__init__.py` lists its files, and its `__init__.pyi` the names that it exports. Its tests are in
`tests/ROOM`.
"""

from mocap._shared import faces

__version__ = "0.2.0"

# Each name is imported at its first use, so that `import mocap` is quick; `__init__.pyi` lists them.
__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

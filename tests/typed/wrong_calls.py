"""Mistakes that users make: pyright and mypy report each line that says `wrong`, and no other line."""

import mocap
import mocap.grahps  # wrong: a room's name misspelt
from mocap import body, datasets, editing, feet, files, graphs, matching, steering, synthesis, widgets
from mocap import qualty  # wrong: a room's name misspelt
from mocap.body import forward_kinematic  # wrong: no name of this room
from mocap.steering import build  # wrong: a name of another room

walk = datasets.sample("walk_curve_1")
line = body.GroundPath([[0, 0], [0, 6]])

graphs.bild([walk], window=10, threshold=0.04)  # wrong: a typo
graphs.build([walk], window=10)  # wrong: no threshold
graphs.build([walk], window="10", threshold=0.04)  # wrong: a text for a number
graphs.build(walk, window=10, threshold=0.04)  # wrong: one motion for a list
graphs.build([walk], 10, 0.04)  # wrong: options without their names
graphs.build([walk], window=10, treshold=0.04)  # wrong: an option misspelt
graphs.build([walk], window=10, threshold=0.04, weights=[1.0])  # wrong: an option of no function
graphs.build(["walk.bvh"], window=10, threshold=0.04)  # wrong: a path for a motion
mocap.resample([walk], 30)  # wrong: a list for one motion
mocap.resample(walk)  # wrong: no rate
mocap.concatenate(walk, walk)  # wrong: two motions for a list
mocap.load(["walk.bvh"])  # wrong: a list for one path
mocap.save("walk.bvh", walk)  # wrong: the arguments in another order
mocap.walk("walk.bvh")  # wrong: no such name
files.load("walk.bvh").root_position  # wrong: no such field
walk.duration()  # wrong: a number is called
walk[3]  # wrong: a frame is no motion
walk.fps = 60  # wrong: a motion does not change
body.GroundPath([0, 6])  # wrong: numbers for points
body.GroundPath("path.csv")  # wrong: a path for points
matching.find_transitions([walk], window=10, threshold=0.04)  # wrong: it is called `below` here
synthesis.random_walk([walk], seconds=4)  # wrong: clips for a graph
steering.follow_path(line, graphs.load("graph.npz"))  # wrong: the arguments in another order
steering.follow_path(graphs.load("graph.npz"), line, widht=100)  # wrong: an option misspelt
steering.Settings(deadline="5s")  # wrong: a text for a number
feet.clean_up([walk])  # wrong: a list for one motion
editing.mirror()  # wrong: no motion
editing.bend(walk, [0, 5])  # wrong: numbers for points
walk.positions()  # wrong: an array is called
widgets.play([walk])  # wrong: a list for motions one by one
len(datasets.cmu("16_15", subject=16))  # wrong: a trial and a person

"""Group motion graphs: a crowd that was planned, after [LCF05].

The same idea as a motion graph, one storey higher. A pose is where all members of a group are and how they
move; a clip is a few seconds of the whole group, simulated beforehand; nodes are configurations that come
again and again. A search strings clips together, so that the group passes points and keeps clear of
obstacles. Then each member's way is walked by a character of a motion graph.

Take this where a group stays together and must find its way. `steering.walk_crowd` is for a few characters
whose paths are given and cross.

Only the abstract of [LCF05] could be had. From it are: nodes by clustering, clips that join them by
constrained simulation, and a search that known bounds make easy. All else is ours.

Reading order (notebook 19)
---------------------------
1. `flocking`: walking people simulated by three rules
2. `configurations`: when do two groups stand and move alike, and which moments come again?
3. `group_clips`: clips that lead from node to node, by constrained simulation
4. `group_graphs`: the graph, and what a walk through it plays
5. `group_storage`: save a graph to .npz, and read it again
6. `planning`: where to go, what stands in the way, and a search for the way
7. `group_steering`: the same without a plan, and the quicker of the two
8. `group_walkers`: a character of a motion graph for each member

References
----------
.. [LCF05] Y.-C. Lai, S. Chenney, S. Fan, *Group Motion Graphs*, SCA 2005, doi 10.1145/1073368.1073409.
.. [AMC03] M. Anderson, E. McDaniel, S. Chenney, *Constrained Animation of Flocks*, SCA 2003.
.. [Rey87] C. Reynolds, *Flocks, Herds, and Schools*, SIGGRAPH 1987, doi 10.1145/37402.37406.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

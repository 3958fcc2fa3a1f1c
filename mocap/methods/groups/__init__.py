"""Group motion graphs: planned motion of a crowd, after [LCF05].

A group motion graph is a motion graph one level higher. In place of a pose it has a configuration, the
positions and velocities of all members of a group. In place of a captured clip it has a few seconds of the
whole group, simulated beforehand. Nodes are configurations that recur. A search finds a sequence of clips
that passes given points and avoids obstacles. Then a character of a motion graph follows the path of each
member.

Use these functions if a group stays together and must find its path: `lead_group` finds it, and `walk_group`
gives each member a character. `plan_group` and `steer_group` are its two parts, for experiments.
`steering.walk_crowd` is for characters whose given paths cross.

Only the abstract of [LCF05] was available. It is the source of the nodes by clustering, of the clips that
join them by constrained simulation, and of the search that known bounds accelerate. All other parts are ours.

Reading order (notebook 19)
---------------------------
1. `flocking`: walking people simulated by three rules
2. `configurations`: the distance between two groups, and the configurations that recur
3. `group_clips`: clips that lead from node to node, by constrained simulation
4. `group_graphs`: the graph, and the trajectories of a walk through it
5. `group_storage`: save a graph to .npz and load it
6. `planning`: points, obstacles, and a search for a path
7. `group_steering`: `lead_group`, the faster of steering and planning, and steering without a plan
8. `group_walkers`: a character of a motion graph for each member
9. `tuned`: the constants that trials chose

References
----------
.. [LCF05] Y.-C. Lai, S. Chenney, S. Fan, *Group Motion Graphs*, SCA 2005, doi 10.1145/1073368.1073409.
.. [AMC03] M. Anderson, E. McDaniel, S. Chenney, *Constrained Animation of Flocks*, SCA 2003.
.. [Rey87] C. Reynolds, *Flocks, Herds, and Schools*, SIGGRAPH 1987, doi 10.1145/37402.37406.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

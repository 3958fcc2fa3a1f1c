"""Motion graphs: all ways through some clips that look like one motion [KGP02].

`build` finds the transitions and cuts the clips where transitions leave and enter. `prune` keeps the part in
which a walk never ends. The graph itself is a `networkx.MultiDiGraph` of nodes (clip, frame).

Reading order (notebooks 05, 06)
--------------------------------
 1. `motion_graph`: clips, choice points and transitions as one graph; close choice points merged
 2. `components`: strongly connected components, and reachable nodes
 3. `pruning`: remove dead ends and sinks, with a reason for each edge
 4. `thresholds`: the size of the graph at each threshold
 5. `graph_summary`: a graph in numbers; GraphML for other tools
 6. `storage`: save a graph to .npz, and read it again
 7. `edge_tables`: the frames that each edge and each macro-edge (hop) plays, as arrays
 8. `compiled_graph`: a whole graph as arrays, for searches
 9. `homework_graph`: the homework's simpler graph of segments
10. `tuned`: the constants that trials chose

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

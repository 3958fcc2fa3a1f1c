"""Motion graphs: directed graphs of clips and transitions, whose walks are continuous motions [KGP02].

`build` finds the transitions and cuts the clips where transitions leave and enter. `prune` keeps a component
in which every walk can be continued. The graph is a `networkx.MultiDiGraph` of nodes (clip, frame).

Reading order (notebooks 05, 06)
--------------------------------
 1. `motion_graph`: clips, choice points and transitions as one graph, and merging of close choice points
 2. `components`: strongly connected components, and reachable nodes
 3. `pruning`: removal of dead ends and sinks, with a reason for each edge
 4. `thresholds`: the size of the graph as a function of the threshold
 5. `graph_summary`: statistics of a graph, and export to GraphML
 6. `storage`: graphs in .npz files
 7. `edge_tables`: the frames of each edge and of each macro-edge, as arrays
 8. `compiled_graph`: a whole graph as arrays, for searches
 9. `homework_graph`: the homework's simpler graph of segments
10. `tuned`: the constants that trials chose

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

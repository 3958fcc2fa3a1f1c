"""Parametric motion graphs: a node is a space of motions, an edge the boxes of possible successors [HG07].

In a motion graph a node is a frame of a clip. Here it is the space of all motions of one kind, such as
strides by turn and speed, or reaches by the position of the hand, each made by blending. An edge stores for
each of them a box of targets that may follow, and the phases of the transition. Control therefore needs no
search: it looks up the box, and chooses the parameters nearest to the command.

Reading order (notebook 17)
---------------------------
1. `examples`: examples of one action, such as punches, on one grid of phases
2. `strides`: strides and steps, cut where feet strike
3. `stride_spaces`: from a turn to the weights of a blend that has it
4. `stride_changes`: strides of one kind that fade into those of another
5. `made_motions`: motions made by blending, and the best moments to leave one and enter another
6. `parametric_edges`: boxes of targets that may follow; spaces and edges as a graph
7. `parametric_storage`: save a graph to .npz, and read it again
8. `parametric_control`: a character that decides once per stride
9. `tuned`: the constants that trials chose

References
----------
.. [HG07] R. Heck, M. Gleicher, *Parametric Motion Graphs*, I3D 2007, doi 10.1145/1230100.1230123.
.. [KG03] L. Kovar, M. Gleicher, *Flexible Automatic Motion Blending with Registration Curves*, SCA 2003,
   doi 10.5555/846276.846307.
.. [KG04] L. Kovar, M. Gleicher, *Automated Extraction and Parameterization of Motions in Large Data Sets*,
   SIGGRAPH 2004, doi 10.1145/1015706.1015760.
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

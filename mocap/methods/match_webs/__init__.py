"""Match webs: all motions similar to one example, and parameterised spaces of their blends [KG04].

A set of clips contains the same action n times, and two of its instances may differ much. But each instance
has a near neighbour. The search therefore proceeds in steps: motions similar to the query, then motions
similar to those. The *match web* stores all long paths of similar frames, found once, so that each step is a
lookup [KG04]. The matches are registered to one clock (`blending.register`) and become a *space*. For a
target, such as a change of heading of 40° at 1.3 m/s or a position of the hand, it provides the weights of a
blend.

Reading order (notebook 16)
---------------------------
1. `local_alignment`: minima of a distance grid, and paths through it that begin and end anywhere
2. `webs`: `MatchWeb`, all paths of a set of clips, found once
3. `web_storage`: save a web to .npz and load it
4. `match_search`: motions similar to a query, step by step
5. `motion_spaces`: measures of a motion, and random blends of examples with their measures
6. `target_weights`: blend weights for a target
7. `tuned`: the constants that trials chose

References
----------
.. [ACP02] B. Allen, B. Curless, Z. Popović, *Articulated Body Deformation from Range Scan Data*,
   SIGGRAPH 2002.
.. [HG07] R. Heck, M. Gleicher, *Parametric Motion Graphs*, I3D 2007, doi 10.1145/1230100.1230123.
.. [KG03] L. Kovar, M. Gleicher, *Flexible Automatic Motion Blending with Registration Curves*, SCA 2003,
   doi 10.5555/846276.846307.
.. [KG04] L. Kovar, M. Gleicher, *Automated Extraction and Parameterization of Motions in Large Data Sets*,
   SIGGRAPH 2004, doi 10.1145/1015706.1015760.
.. [SW81] T. F. Smith, M. S. Waterman, *Identification of Common Molecular Subsequences*, Journal of Molecular
   Biology 147, 1981, doi 10.1016/0022-2836(81)90087-5.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

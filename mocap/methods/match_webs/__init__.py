"""From one example of a motion to all others like it, and to a space of blends between them.

A set of clips holds the same action many times, and no two times alike in numbers. But each has a near
neighbour. So the search goes in steps: what is like the query, then what is like that. The *match web* holds
all long paths of frames that are alike, found once, so that each step is a lookup [KG04]. What is found is
laid on one clock (`blending.register`) and becomes a *space*: ask for a turn of 40° at 1.3 m/s, or for a hand
at a place, and get the weights of the blend that does it.

Reading order (notebooks 16)
----------------------------
1. `local_alignment`: valleys of a grid, and paths through it that begin and end anywhere; piece by piece
2. `webs`: `MatchWeb`, all paths of a set of clips, found once
3. `web_storage`: save a web to .npz, and read it again
4. `match_search`: what is like the query, and what is like that
5. `motion_spaces`: what a motion does, in a number or a few; blends of examples, drawn at random and measured
6. `wishes`: from a wish back to weights

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

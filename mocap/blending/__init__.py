"""Blending: transitions by a blend over a window or by inertialization, and blends of whole registered clips.

A transition starts with two similar windows. The second clip is aligned with the first. Then the poses are
blended, or the second clip plays with an offset that fades to zero. Whole clips, two or more, are first
registered: registration finds their corresponding frames, and the transforms that align them there.

Reading order (notebooks 04, 15)
--------------------------------
1. `weights`: the weight of the first motion in each frame of a transition
2. `joining`: transitions between two motions, by a blend over a window or by inertialization
3. `timewarps`: smooth curves over time with bounded slopes
4. `clocks`: clips on a common clock, their matching footplants, and the clock of a blend
5. `mixing`: blends of registered clips, with constant or time-varying weights, and long crossfades
6. `registering`: corresponding frames of clips, and the transforms that align them
7. `tuned`: the constants that trials chose

References
----------
.. [Bol18] D. Bollo, *Inertialization: High-Performance Animation Transitions in Gears of War*, GDC 2018.
.. [KG03] L. Kovar, M. Gleicher, *Flexible Automatic Motion Blending with Registration Curves*, SCA 2003,
   doi 10.5555/846276.846307.
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
.. [WP95] A. Witkin, Z. Popović, *Motion Warping*, SIGGRAPH 1995, doi 10.1145/218380.218422.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

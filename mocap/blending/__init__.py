"""From one motion into another: by a blend over a window, or by a cut whose offset dies away.

Both ways start with two windows that look alike. The second clip is laid on the first; then the poses are
mixed, or the second clip plays with an offset that fades. Whole clips, two or more, are first registered:
which of their frames belong together, and how they lie on one another there.

Reading order (notebooks 04, 15)
--------------------------------
1. `weights`: how much of the first motion each frame holds
2. `joining`: two motions into one; from clip into clip by a blend, or a cut whose offset dies away
3. `timewarps`: smooth curves over time whose slope stays within bounds
4. `clocks`: clips on one common clock, the plants that they share, and the blend's own clock
5. `mixing`: registered clips blended by weights, constant or moving; from one into another at leisure
6. `registering`: which frames of clips belong together, and how they lie on one another

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

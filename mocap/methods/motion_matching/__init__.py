"""Motion matching: compare with all frames while one walks; the room `matching` compares beforehand [Cla16].

There is no graph. Every 0.1 s a character compares its own pose, and the future that is asked for, with all
frames of all clips, and plays on from the frame that fits best. It needs no transitions and no pruning, and
obeys sooner; it knows nothing of what comes later.

Reading order (notebook 18)
---------------------------
1. `pose_database`: what a frame is like, in 27 numbers, and all frames side by side
2. `nearest_frames`: which frame is most like the one asked for? Springs, by which wishes come and go
3. `matching_control`: a character that searches, cuts, and lets what differs die away

References
----------
.. [Cla16] S. Clavet, *Motion Matching and the Road to Next-Gen Animation*, GDC 2016.
.. [Hol20] D. Holden, O. Kanoun, M. Perepichka, T. Popa, *Learned Motion Matching*, SIGGRAPH 2020,
   doi 10.1145/3386569.3392440.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

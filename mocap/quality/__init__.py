"""Measures: flaws of a clip, the quality of a seam, the acceleration of a fall, and judgements of motions.

A seam is compared with the clips' own windows of the same length: a jump that the clips also have does not
count. A new measure of clips goes into `clip_flaws`, one of seams into `seam_measures`, and one of whole
motions into `judging`, with its limit.

Reading order (notebooks 01, 04, 09 to 11)
----------------------------------------
1. `clip_flaws`: a clip's duration, its path and its flaws
2. `seam_measures`: foot sliding, jumps of velocity at a seam, rotating knees
3. `falling`: the centre of mass, and its acceleration in a flight
4. `joint_limits`: joints that bend beyond the limits of people's
5. `judging`: any motion in a few numbers, each divided by its limit
6. `limits`: the limits, which captured people keep

References
----------
.. [AAOS65] American Academy of Orthopaedic Surgeons, *Joint Motion: Method of Measuring and Recording*, 1965.
.. [Winter09] D. A. Winter, *Biomechanics and Motor Control of Human Movement*, 4th ed., Wiley 2009.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

"""Feet that stand: find footplants, and clean up footskate in the five steps of [KSG02].

Captured feet drift while they stand, and blended feet slide. `clean_up` gives each plant one place and bends
the legs so that the foot stays there. The files below follow the steps of the paper.

Reading order (notebook 04)
---------------------------
1. `footplants`: when does a foot stand, and where?
2. `leg_track`: one leg over a clip: how its knee bends to reach, and its pose (step 4)
3. `ankle_targets`: where ankles must be, and how they come there and leave (steps 1, 2 and 5)
4. `least_bending`: the root's height and the knees, all at once (steps 3 and 4)
5. `footskate`: the five steps in one function

How the constants were set
--------------------------
Each file names its constants at the top, each with its unit and with what another value does. Those of
plants were measured on the bundled clips, whose true plants are known, and give an F1 of 0.998 in the worst
of them; a foot stands for 50 % of the time of captured walks and 33 % of runs'. Those of the clean-up were
measured at 30, 60 and 120 Hz on 135 clips (walks, runs, jumps, dance, golf), as they are, with straight legs,
slowed, smoothed and swaying, 3 234 in all: 99.998 % of the planted frames are kept, of the worst 97 %.

References
----------
.. [KSG02] L. Kovar, J. Schreiner, M. Gleicher, *Footskate Cleanup for Motion Capture Editing*, SCA 2002,
   doi 10.1145/545261.545277.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

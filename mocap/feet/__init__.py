"""Feet that stand: find footplants, and clean up footskate in the five steps of [KSG02].

Captured feet drift while they stand, and blended feet slide. `clean_up` gives each plant one place and bends
the legs so that the foot stays there. The files below follow the steps of the paper.

Reading order (notebook 04)
---------------------------
1. `footplants`: when does a foot stand, and where?
2. `leg_track`: one leg over a clip: how far its knee lets it reach, and its ankle elsewhere (step 4)
3. `ankle_targets`: where ankles must be, and how they come there and leave (steps 1, 2 and 5)
4. `root_height`: how far the root rises or falls (step 3)
5. `knee_smoothing`: no knee jolts more than it did
6. `footskate`: the five steps in one function

How the constants were set
--------------------------
Each file names its constants at the top, each with its unit and with what another value does. That was
measured on four sets at 30 and 120 Hz: the bundled clips, whose true plants are known (F1 is how well found
plants agree with them); skating clips (bundled ones with the root pushed by 4 and 20 mm, joins, and random
walks); walks captured from CMU's subject 16, and random walks through them; and his runs. As they are, the
constants give an F1 of 0.998 in the worst bundled clip; a foot stands for 50 % of the walks' time and 33 % of
the runs'; and clean-ups keep 100 %, 99.8 % and 93 % of the planted frames of skating clips, walks and runs.

References
----------
.. [KSG02] L. Kovar, J. Schreiner, M. Gleicher, *Footskate Cleanup for Motion Capture Editing*, SCA 2002,
   doi 10.1145/545261.545277.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "footplants": ["find_footprints", "mark_plants", "runs", "standing_tracks"],
        "ankle_targets": ["place_plants"],
        "footskate": ["clean_up"],
    },
)

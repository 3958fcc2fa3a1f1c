"""Datasets: bundled clips, trials of the CMU database, and datasets of other laboratories.

Reading order (notebooks 01, 10, 11)
------------------------------------
 1. `samples`: the bundled clips by name
 2. `downloads`: downloads of small files, which are cached
 3. `cmu_database`: trials of the CMU database
 4. `partial_files`: partially downloaded files, and the space for the rest
 5. `resumed_downloads`: downloads of large files that resume after an interruption
 6. `unpacking`: clips in an archive, unpacked with limits on its size
 7. `named_sets`: datasets of other laboratories, with their licences, hips and legs
 8. `clip_origins`: the files from which clips were read, to read them again
 9. `clip_licences`: licences that a user states, and those of known data sets
10. `packed_clips`: clips as compact arrays, for files that carry their clips
11. `clip_references`: the clips of a saved graph or web, to find them again and compare them
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

"""Clips to begin with: eight that come with the package, those of the CMU database, and sets of other labs.

Reading order (notebooks 01, 10, 11)
------------------------------------
1. `samples`: the bundled clips by name
2. `downloads`: small files from the network, fetched once and kept
3. `cmu_database`: trials of the CMU database
4. `partial_files`: partially downloaded files, and the space for the rest
5. `resumed_downloads`: large files, whose download continues where it broke off
6. `unpacking`: clips out of an archive, within bounds on what it may claim
7. `named_sets`: sets of other labs, with their licences, hips and legs
8. `clip_origins`: the files that clips were read from, to read them again
9. `clip_references`: the clips of a saved graph or web, to find them again and compare them
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

"""Clips to begin with: eight that come with the package, those of the CMU database, and sets of other labs.

Reading order (notebooks 01, 10, 11)
------------------------------------
1. `samples`: the bundled clips by name
2. `downloads`: files from the network, fetched once and kept
3. `cmu_database`: trials of the CMU database
4. `named_sets`: sets of other labs, with their licences, hips and legs
5. `clip_origins`: where clips were read from, to read them again
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

"""Clips to begin with: eight that come with the package, those of the CMU database, and sets of other labs.

Reading order (notebooks 01, 10, 11)
------------------------------------
1. `samples`: the bundled clips by name
2. `cmu_database`: trials of the CMU database, fetched once
3. `clip_origins`: where clips were read from, to read them again
4. `known_sets`: licences, addresses, and which joints are hips and legs
5. `resumed_downloads`: a download that goes on where it broke off
6. `unpacked_clips`: the clips of an archive, and their checksums
7. `set_clips`: fetch a set, list its clips, read one
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "samples": ["SAMPLES", "sample"],
        "known_sets": ["SETS", "NamedSet"],
        "set_clips": ["fetch_set", "from_set", "list_set"],
        "clip_origins": ["Origin"],
        "cmu_database": ["TERMS", "Trial", "cmu", "trials"],
    },
)

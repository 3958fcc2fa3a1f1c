"""Clips to begin with: eight that come with the package, those of the CMU database, and sets of other labs.

The bundled clips are generated: footsteps planned along a path, a few harmonics for each joint, and inverse
kinematics for the legs; the jump is stored as it is. The course does not need to know how: files 4 to 8 can
be read last.

Reading order (notebooks 01, 10, 11)
------------------------------------
 1. `samples`: the bundled clips by name
 2. `cmu_database`: trials of the CMU database, fetched once
 3. `clip_origins`: where clips were read from, to read them again
 4. `generated`: walks generated from tables of figures
 5. `gait`: what a body does in one cycle; `walker.toml` holds its figures
 6. `gait_timing`: how far, in which phase and gait, frame by frame
 7. `footsteps`: where the feet go
 8. `walking_body`: the body that walks, and its legs
 9. `known_sets`: licences, addresses, and which joints are hips and legs
10. `resumed_downloads`: a download that goes on where it broke off
11. `unpacked_clips`: the clips of an archive, and their checksums
12. `set_clips`: fetch a set, list its clips, read one
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
        "generated": ["generate", "generate_walk"],
    },
)

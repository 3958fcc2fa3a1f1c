"""Where motion comes from and goes to: ASF/AMC, BVH, and paths as CSV or SVG.

Units are converted here and nowhere else: inside the package all lengths are metres and all angles radians.
A file is read whole or refused, with the line that breaks its format. A new format gets a file with its
reader and its writer; `load_save` chooses them by the suffix, and lists the suffixes in `FORMATS`.

Reading order (notebooks 01, 10)
--------------------------------
 1. `load_save`: load and save; the suffix decides
 2. `text`: text files, their lines and numbers, checked
 3. `asf`: the skeleton of Acclaim files
 4. `amc`: the numbers of Acclaim files, bone by bone
 5. `acclaim`: what those numbers mean
 6. `acclaim_writer`: motions as Acclaim files
 7. `bvh_hierarchy`: the skeleton of BVH files
 8. `bvh`: BVH files, read and written
 9. `path_files`: paths from .csv and .svg
10. `conversion`: whole folders at once
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "load_save": ["find_files", "load", "load_all", "load_skeleton", "read_angles", "save"],
        "path_files": ["load_path"],
        "conversion": ["Options", "Outcome", "convert", "plan"],
    },
)

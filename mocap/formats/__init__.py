"""The formats of motion files, each read and written in files of its own: ASF/AMC and BVH.

A file is read whole or refused, with the line that breaks its format. Units are converted here and nowhere
else: inside the package all lengths are metres and all angles radians. `files.load` and `files.save` choose
the format by the suffix; few programs need this room itself.

Reading order (notebook 01)
---------------------------
1. `text`: text files, their lines and numbers, checked
2. `asf`: the skeleton of Acclaim files
3. `amc`: the numbers of Acclaim files, bone by bone
4. `acclaim`: what those numbers mean
5. `acclaim_writer`: motions as Acclaim files
6. `bvh_hierarchy`: the skeleton of BVH files
7. `bvh`: BVH files, read and written
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__, submodules=["acclaim", "acclaim_writer", "amc", "asf", "bvh", "bvh_hierarchy", "text"]
)

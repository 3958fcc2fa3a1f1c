"""The formats of motion files, each in files of its own: ASF/AMC, BVH, AMASS .npz, and glTF to look at.

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
 7. `rigid_bones`: rigid bones for files whose bones change length
 8. `bvh`: BVH files, read and written
 9. `amass`: the archives of AMASS, for the 22 joints of the SMPL body
10. `gltf`: a skeleton, its motion and a body around it, for engines and viewers

References
----------
.. [AMASS19] N. Mahmood, N. Ghorbani, N. F. Troje, G. Pons-Moll, M. J. Black, *AMASS: Archive of Motion
   Capture As Surface Shapes*, ICCV 2019, doi 10.1109/ICCV.2019.00554.
.. [GLTF21] Khronos Group, *glTF 2.0 Specification*, version 2.0.1, 2021.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submodules=[
        "acclaim",
        "acclaim_writer",
        "amass",
        "amc",
        "asf",
        "bvh",
        "bvh_hierarchy",
        "gltf",
        "rigid_bones",
        "text",
    ],
)

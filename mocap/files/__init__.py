"""Where motion comes from and goes to: motion files by their suffix, and paths as CSV or SVG.

A file is read whole or refused, with the line that breaks its format. Each format has its reader and
its writer here; `load_save` chooses them by the suffix.

Reading order (notebooks 01, 10)
-------------------------------
 1. `load_save`: load and save; the suffix decides
 2. `folders`: which motion files there are
 3. `conversion`: whole folders at once
 4. `number_tables`: tables of numbers in .csv files
 5. `path_files`: paths from .csv and .svg
 6. `text`: text files, their lines and numbers, checked
 7. `asf`: the skeleton of Acclaim files
 8. `amc`: the numbers of Acclaim files, bone by bone
 9. `acclaim`: what those numbers mean
10. `acclaim_writer`: motions as Acclaim files
11. `bvh_hierarchy`: the skeleton of BVH files
12. `rigid_bones`: rigid bones for files whose bones change length
13. `bvh`: BVH files, read and written
14. `amass`: the archives of AMASS, for the 22 joints of the SMPL body
15. `gltf_capsules`: a body for a viewer to show, rigid pieces around the bones
16. `gltf`: joints, skin and animation, and the file

References
----------
.. [AMASS19] N. Mahmood, N. Ghorbani, N. F. Troje, G. Pons-Moll, M. J. Black, *AMASS: Archive of Motion
   Capture As Surface Shapes*, ICCV 2019, doi 10.1109/ICCV.2019.00554.
.. [GLTF21] Khronos Group, *glTF 2.0 Specification*, version 2.0.1, 2021.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "load_save": ["bone_stretch", "load", "load_skeleton", "read_angles", "save"],
        "folders": ["find_files", "load_all"],
        "number_tables": ["load_rows"],
        "path_files": ["load_path"],
        "conversion": ["convert", "plan"],
    },
)

"""Where motion comes from and goes to: motion files by their suffix, and paths as CSV or SVG.

A file is read whole or refused, with the line that breaks its format. Each format has its reader and
its writer here; `load_save` chooses them by the suffix, and `formats` lists those that are read.

Reading order (notebooks 01, 10)
-------------------------------
 1. `load_save`: load and save; the suffix decides
 2. `formats`: the formats that are read, one table
 3. `conversion`: which motion files there are, and whole folders of them converted
 4. `path_files`: paths from .csv and .svg
 5. `text`: text files, their lines, numbers and tables, checked
 6. `recordings`: what a motion file says, besides the motion
 7. `asf`: the skeleton of Acclaim files
 8. `acclaim`: the numbers of Acclaim files, and what they mean
 9. `bvh_hierarchy`: the skeleton of BVH files
10. `rigid_bones`: rigid bones for files whose bones change length
11. `bvh`: BVH files, read and written
12. `amass`: the archives of AMASS, for the 22 joints of the SMPL body
13. `gltf_capsules`: a body for a viewer to show, rigid pieces around the bones
14. `gltf`: joints, skin and animation, and the file

References
----------
.. [AMASS19] N. Mahmood, N. Ghorbani, N. F. Troje, G. Pons-Moll, M. J. Black, *AMASS: Archive of Motion
   Capture As Surface Shapes*, ICCV 2019, doi 10.1109/ICCV.2019.00554.
.. [GLTF21] Khronos Group, *glTF 2.0 Specification*, version 2.0.1, 2021.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

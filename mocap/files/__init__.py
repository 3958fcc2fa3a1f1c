"""Readers and writers of motion files, and readers of paths as CSV or SVG.

A file is read whole or refused, with the line that breaks its format. Each format has its reader and
its writer here; `load_save` chooses them by the suffix, and `formats` lists those that are read.

Reading order (notebooks 01, 10)
-------------------------------
 1. `load_save`: load and save; the suffix decides
 2. `formats`: the formats that are read, one table
 3. `conversion`: motion files in folders, and their conversion
 4. `path_files`: paths from .csv and .svg
 5. `svg_strokes`: the commands of an SVG path, and the points that they draw
 6. `text`: text files, their lines, numbers and tables, checked
 7. `recordings`: a motion with the angles and the stretch of its file
 8. `asf`: the skeleton of Acclaim files
 9. `acclaim`: the numbers of Acclaim files, and the motion that they describe
10. `bvh_hierarchy`: the skeleton of BVH files
11. `rigid_bones`: rigid bones for files whose bones change length
12. `bvh`: BVH files, read and written
13. `amass`: the archives of AMASS, for the 22 joints of the SMPL body
14. `gltf_capsules`: a body for a viewer to show, rigid pieces around the bones
15. `gltf`: joints, skin and animation, and the file
16. `role_maps`: the roles of joints, as TOML
17. `loose_joints`: joints of a file that are no part of the body

References
----------
.. [AMASS19] N. Mahmood, N. Ghorbani, N. F. Troje, G. Pons-Moll, M. J. Black, *AMASS: Archive of Motion
   Capture As Surface Shapes*, ICCV 2019, doi 10.1109/ICCV.2019.00554.
.. [GLTF21] Khronos Group, *glTF 2.0 Specification*, version 2.0.1, 2021.
.. [SVG11] World Wide Web Consortium, *Scalable Vector Graphics (SVG) 1.1 (Second Edition)*, 2011.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

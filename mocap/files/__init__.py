"""Readers and writers of motion files, and readers of paths in CSV and SVG files.

A file is read completely or rejected, with the line that breaks its format. `load_save` chooses the reader or
writer by the suffix, and `formats` lists the formats that can be read.

Reading order (notebooks 01, 10)
--------------------------------
 1. `load_save`: load and save, by the suffix
 2. `formats`: the table of formats that can be read
 3. `conversion`: search for motion files in folders, and their conversion
 4. `path_files`: paths from .csv and .svg files
 5. `svg_drawings`: the lines of an SVG picture, and which of them is meant
 6. `svg_shapes`: the lines of one element of a picture, as points
 7. `text`: checked reading of text files, lines, numbers and tables
 8. `decimals`: the numbers of a long text, converted many at a time
 9. `space_evidence`: evidence of a clip's unit and vertical axis, from its frames
10. `spaces`: the decision on the unit and the vertical axis
11. `recordings`: a motion with the angles and the bone stretch of its file
12. `clip_sets`: several files with one unit and one vertical axis
13. `frame_rates`: frame rates from frame times of few digits
14. `asf`: the skeleton of Acclaim files
15. `acclaim`: the numbers of Acclaim files, and the motion that they describe
16. `bvh_hierarchy`: the skeleton of BVH files
17. `loose_joints`: joints of a file that are no part of the body
18. `rigid_bones`: rigid bones for files whose bones change length
19. `bvh`: reader and writer of BVH files
20. `amass`: the archives of AMASS, for the 22 joints of the SMPL body
21. `role_maps`: the roles of joints, as TOML
22. `gltf_capsules`: a body surface of rigid capsules around the bones
23. `gltf`: writer of glTF files, with joints, skin and animation
24. `tuned`: the constants that trials chose

References
----------
.. [AMASS19] N. Mahmood, N. Ghorbani, N. F. Troje, G. Pons-Moll, M. J. Black, *AMASS: Archive of Motion
   Capture As Surface Shapes*, ICCV 2019, doi 10.1109/ICCV.2019.00554.
.. [CLINGER90] W. D. Clinger, *How to Read Floating Point Numbers Accurately*, PLDI 1990,
   doi 10.1145/93542.93557.
.. [GLTF21] Khronos Group, *glTF 2.0 Specification*, version 2.0.1, 2021.
.. [SVG11] World Wide Web Consortium, *Scalable Vector Graphics (SVG) 1.1 (Second Edition)*, 2011.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

"""Readers and writers of motion files, and readers of paths in CSV and SVG files.

A file is read completely or rejected, with the line that breaks its format. `load_save` chooses the reader or
writer by the suffix, and `formats` lists the formats that can be read.

Reading order (notebooks 01, 10)
--------------------------------
 1. `load_save`: load and save, by the suffix
 2. `formats`: the table of formats that can be read
 3. `read_options`: the options of `load`, as readers of formats receive them
 4. `conversion`: search for motion files in folders, and their conversion
 5. `path_files`: paths from .csv and .svg files
 6. `svg_drawings`: the lines of an SVG picture, and which of them is meant
 7. `svg_shapes`: the lines of one element of a picture, as points
 8. `text`: checked reading of text files, lines, numbers and tables
 9. `decimals`: the numbers of a long text, converted many at a time
10. `space_evidence`: evidence of a clip's unit and vertical axis, from its frames
11. `spaces`: the decision on the unit and the vertical axis
12. `recordings`: a motion with the angles and the bone stretch of its file
13. `clip_sets`: several files with one unit and one vertical axis
14. `frame_rates`: frame rates from frame times of few digits
15. `asf`: the skeleton of Acclaim files
16. `acclaim`: the numbers of Acclaim files, and the motion that they describe
17. `bvh_hierarchy`: the skeleton of BVH files
18. `loose_joints`: joints of a file that are no part of the body
19. `rigid_bones`: rigid bones for files whose bones change length
20. `bvh`: reader and writer of BVH files
21. `motion_archives`: reader and writer of `.npz` archives
22. `amass`: the layout of AMASS in archives, for the 22 joints of the SMPL body
23. `position_tables`: writer of joint positions as `.csv`
24. `role_maps`: the roles of joints, as TOML
25. `plain_names`: names of joints that three.js keeps
26. `gltf_capsules`: a body surface of rigid capsules around the bones
27. `gltf_rest`: a rest pose that stands on the floor
28. `gltf_bones`: the directions of bones, and the axes of joints along them
29. `gltf`: writer of glTF files, with joints, skin and animation
30. `named_tables`: tables with named columns
31. `label_tables`: labels of clips from tables
32. `directions`: lines with times, headings, labels and waits
33. `tuned`: the constants that trials chose

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

"""Animations in a browser: the player, and experiments with sliders.

The player is one script that runs in JupyterLab and in a stand-alone page, without a network. An experiment
is a picture that is redrawn when its controls move.

Reading order (notebooks 00 to 19)
----------------------------------
 1. `embedding`: a player as part of a page, as a page, and as a picture without scripts
 2. `player`: motions packed as numbers for all scripts, and the player for pages and notebooks
 3. `live`: live widgets, and a picture when the notebook is opened again
 4. `shared_traits`: the state that browser and Python share
 5. `live_player`: players whose scene Python changes: a canvas for paths, and sliders of a blend
 6. `pointing`: handles to drag
 7. `experiments`: a picture with controls
 8. `walk_figure`: the capsules of a body
 9. `shaded_picture`: bodies and their shadows, drawn without a browser
10. `filmed_scene`: the picture of a player at a given time
11. `still_bodies`: the bodies of a still picture, apart from each other
12. `still_picture`: the picture of a player without scripts
13. `film`: a motion as a film, a still picture or a page
14. `company`: characters that are stepped together, and the delay of each response
15. `steered_widget`: characters side by side that obey one command of the reader
16. `steered_session`: a character that a page steers, and its last minutes for recordings
17. `steering_server`: the page for steering, and its server on the own machine
18. `walk_bending`: walks bent onto a line, with feet that stand still
19. `walk_kinds`: the kinds of motion that can follow lines
20. `walking_page`: a page on which a figure walks along drawn lines
21. `link_picture`: the picture that a link to this page shows

References
----------
.. [Gle01] M. Gleicher, *Motion Path Editing*, I3D 2001, doi 10.1145/364338.364400.
.. [KG03] L. Kovar, M. Gleicher, *Flexible Automatic Motion Blending with Registration Curves*, SCA 2003,
   doi 10.5555/846276.846307.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

"""What moves in a browser: the player, and experiments with sliders.

The player is one script that runs in JupyterLab and on a page of its own, without a network. An experiment is
a picture that is drawn anew when its controls move.

Reading order (notebooks 00 to 19)
----------------------------------
 1. `embedding`: what plays, as part of a page, as a page, and where nothing plays
 2. `player`: a motion that plays, on a page or in a notebook
 3. `live_player`: players that Python and the reader move together, and a canvas to draw a path on
 4. `live_mixing`: a blend whose weights sliders change while it plays
 5. `experiments`: a picture with controls
 6. `pointing`: an image to click on
 7. `dragging`: handles to drag on an experiment's picture
 8. `reopening`: live while Python runs, a picture when the notebook is opened again
 9. `recording`: positions of an experiment, as pictures for pages without Python
10. `film`: a motion as a film, a strip of poses or a page
11. `command_clocks`: how long a character has waited, and whether it obeys
12. `company`: characters that take their steps together, under one order
13. `steered_widget`: pictures in a notebook, the reader's command, and a recording for other pages

References
----------
.. [KG03] L. Kovar, M. Gleicher, *Flexible Automatic Motion Blending with Registration Curves*, SCA 2003,
   doi 10.5555/846276.846307.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "player": ["Player", "play"],
        "live_player": ["draw_path", "linked"],
        "live_mixing": ["Mixer"],
        "experiments": ["Experiment", "explore", "step_aside"],
        "pointing": ["Pointed", "pointer"],
        "dragging": ["Dragged", "handles"],
        "film": ["save_animation"],
        "steered_widget": ["steered"],
    },
)

"""The course before a class: slides, films and drawings that are made from the notebooks.

Decks are written by hand; their pictures, players, recordings and code are those of the notebooks.
The commands `mocap course slides`, `mocap course film` and `mocap course board` do this.

Reading order
-------------
1. `slides`: the slides of a deck, what they show of a notebook, and pages of them for reveal.js
2. `films`: what a film of a deck shows, for how long, above which words; its pictures, and the film
3. `board`: drawings for the board, in numbered steps
"""

from mocap._shared import faces

# The command is the face of this room.
__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)

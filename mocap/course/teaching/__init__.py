"""The course before a class: slides, films and drawings that are made from the notebooks.

Nothing is written twice: headings, sentences, pictures, players and recordings are those of the notebooks.
The commands `mocap course slides`, `mocap course film` and `mocap course board` do this.

Reading order
-------------
1. `prose`: Markdown as paragraphs and sentences, and the first sentence of each
2. `deck`: which cells make which slide, by rules and by tags
3. `slides`: the decks as pages for reveal.js, without a network
4. `moving_figures`: the stick figures of a stored player, drawn at a moment
5. `film_script`: what a film of a notebook shows, for how long, above which words
6. `films`: the pictures of a film, and the film
7. `board`: drawings for the board, in numbered steps
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__, submod_attrs={"slides": ["build_slides"], "films": ["render_film"], "board": ["write_board"]}
)

"""The course before a class: slides that are made from the notebooks themselves.

Nothing is written twice: headings, sentences, pictures, players and recordings are those of the notebooks.
The command `mocap course slides` does this.

Reading order
-------------
1. `prose`: Markdown as paragraphs and sentences, and the first sentence of each
2. `deck`: which cells make which slide, by rules and by tags
3. `slides`: the decks as pages for reveal.js, without a network
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "slides": ["build_slides"],
    },
)

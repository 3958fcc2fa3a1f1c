"""Where motion comes from and goes to: motion files by their suffix, and paths as CSV or SVG.

A file is read whole or refused, with the line that breaks its format. The room `formats` below holds the
reader and the writer of each format; `load_save` chooses them by the suffix.

Reading order (notebooks 01, 10)
--------------------------------
1. `load_save`: load and save; the suffix decides
2. `folders`: which motion files there are
3. `conversion`: whole folders at once
4. `number_tables`: tables of numbers in .csv files
5. `path_files`: paths from .csv and .svg
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "load_save": ["bone_stretch", "load", "load_skeleton", "read_angles", "save"],
        "folders": ["find_files", "load_all"],
        "number_tables": ["load_rows"],
        "path_files": ["load_path"],
        "conversion": ["Options", "Outcome", "convert", "plan"],
    },
)

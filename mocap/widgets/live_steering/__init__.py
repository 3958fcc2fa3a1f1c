"""Characters that obey one command, side by side, while Python runs: the reader steers, the browser draws.

Reading order
-------------
1. `command_clocks`: how long a character has waited, and whether it obeys
2. `company`: characters that take their steps together, under one order
3. `steered_widget`: pictures in a notebook, the reader's command, and a recording for other pages
"""

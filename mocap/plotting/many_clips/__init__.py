"""Pictures of many clips at once: clips on one clock, and clips like an example.

Reading order
-------------
1. `registration_charts`: a grid with its time path, plants as bars, tracks over the ground
2. `web_charts`: paths over a grid, matches step by step, samples of a space and a wish
3. `group_plans`: where the members of a group go, seen from above
4. `box_charts`: what may follow one source, and the boxes of all sources
"""

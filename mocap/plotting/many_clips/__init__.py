"""Pictures of many clips at once: clips on one clock.

Reading order
-------------
1. `registration_charts`: a grid with its time path, plants as bars, tracks over the ground
"""

"""Spaces of motions [KG04]: ask for a turn, a speed or a target, and get the blend that does it.

Reading order
-------------
1. `motion_measures`: numbers to ask a motion for
2. `random_blends`: weights of random blends
3. `motion_spaces`: blends of examples, sampled and measured
4. `wishes`: from a wish back to weights
"""

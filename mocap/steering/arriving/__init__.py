"""Between two poses, at their places and in a given time, through the clips of a graph.

A graph gives walks that come near to what is asked. What is left is spread over the whole walk: its path is
bent, its steps are made longer or shorter, its time is stretched, and its ends fade into the poses.

Reading order
-------------
1. `moments`: a pose at a place, and the frames of a graph that look like it
2. `two_sided_search`: walks from the start and from the end that meet half-way
3. `end_bending`: a walk bent and stretched so that it ends where it must
4. `pose_fading`: the last differences faded out, and feet that stand
5. `in_betweens`: all of it in one function, with what it took
"""

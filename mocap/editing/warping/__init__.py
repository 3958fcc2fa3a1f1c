"""Motion warping: a few poses are changed, and smooth curves carry the change to the frames between [WP95].

Each curve θ(t) of a motion becomes a(t) θ(t) + b(t). A key says what one moment must be, one number for
two unknowns; so it is either an offset (a = 1) or a scale (b = 0). The curves a and b are cardinal splines
through the keys. The fine structure of the captured motion stays, for the curves are much smoother than it.

The paper warps a joint's angles one by one. Here a rotation is warped as a whole [ours]: an offset is a
displacement map, q exp(b), and a scale stretches the rotation vector from a reference, r exp(a log(r⁻¹ q)).

Reading order
-------------
1. `keys`: keys, the curve through them, and a warp by offsets
2. `posing`: a key's pose, made by dragging joints
3. `scaling`: a warp by scale
4. `retiming`: time keys, and motions at moments between their frames
5. `looping`: a cycle closed by a warp
6. `warp_plans`: a whole warp out of a small text file
"""

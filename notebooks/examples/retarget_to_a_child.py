"""Retarget a walk to a body of other proportions, and measure what becomes of stride and feet."""

import mocap
from mocap import body, datasets, editing, feet

walk = feet.mark_plants(mocap.resample(datasets.sample("walk_straight"), 60)[:300])
adult = editing.stance_of(walk)  # how the body stands: its legs, its floor, its T-pose
child = editing.proportioned(adult, legs=0.6, trunk=0.7, arms=0.6)

small = editing.retarget(walk, child, adult)  # joint rotations are kept, footplants held
mocap.save(small, "child.bvh")

for name, motion in {"adult": walk, "child": small}.items():
    height = body.joint_positions(motion)[:, :, 1].max()
    distance = abs(motion.root_positions[-1] - motion.root_positions[0]).max()
    print(f"{name}: {height:.2f} m tall, {distance / motion.duration:.2f} m/s")

"""Checks of our files in other programs, which `.ci/release` runs: Blender and Khronos's glTF validator."""

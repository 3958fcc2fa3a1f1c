"""Keep pytest from importing what only Blender's own Python can import."""

collect_ignore = ["in_blender.py"]

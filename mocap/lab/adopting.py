"""A student's function drives the course from the exercise on; until then the package's stands in."""


def mine(name: str) -> str:
    """Return what drives an exercise's place in the course."""
    return name

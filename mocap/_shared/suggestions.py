"""The error for an unknown attribute, with a suggestion."""

from collections.abc import Mapping

from mocap.errors import shortened

SIMILAR = 0.7  # the least similarity of names, from 0 to 1, for a suggestion by spelling


def missing_attribute(thing: object, name: str, expressions: Mapping[str, str]) -> AttributeError:
    """Return the error to raise in `__getattr__` for an unknown attribute.

    Names that begin with an underscore, which Python, pickle and Jupyter look up, get no suggestion.

    Parameters
    ----------
    thing : the object without the attribute.
    name : the name of the attribute.
    expressions : suggestions, by the names of attributes that users may expect.

    Examples
    --------
    >>> missing_attribute(1.5, "size", {"size": "array.size"})
    AttributeError("float has no 'size'; do you mean array.size?")
    >>> missing_attribute(1.5, "reel", {})
    AttributeError("float has no 'reel'; do you mean .real?")
    """
    kind = type(thing).__name__
    lack = f"{kind} has no '{shortened(name, 40)}'"
    if name.startswith("_"):
        return AttributeError(f"{lack}.")
    if hasattr(type(thing), name):
        object.__getattribute__(thing, name)  # a property that failed: its own error is raised
    if name in expressions:
        return AttributeError(f"{lack}; do you mean {expressions[name]}?")
    from difflib import get_close_matches

    names = {*dir(type(thing)), *vars(type(thing)).get("__annotations__", ())}  # with fields
    public = [attribute for attribute in sorted(names) if not attribute.startswith("_")]
    if similar := get_close_matches(name, public, 1, cutoff=SIMILAR):
        return AttributeError(f"{lack}; do you mean .{similar[0]}?")
    return AttributeError(f"{lack}; its fields are in help({kind}).")

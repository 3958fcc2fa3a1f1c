"""A rule that holds for many things is one test, which says of which it fails."""

from collections.abc import Callable, Iterable


def for_each(things: Iterable) -> Callable:
    """Let a test of one thing be one of all these things."""

    def decorate(test: Callable) -> Callable:
        def of_all():
            for thing in things:
                try:
                    test(thing)
                except Exception as error:
                    error.add_note(f"of {thing}")
                    raise

        of_all.__name__, of_all.__doc__ = test.__name__, test.__doc__
        return of_all

    return decorate

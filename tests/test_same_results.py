"""All rooms give what they gave: graphs and walks the same numbers, motions the same to micrometres.

What they gave is in tests/frozen/results, a file for each case; tests/frozen/store.py says what is compared,
and with which tolerance. After a change that is meant,

    pytest --accept-results

computes all cases, stores those that changed, and prints what changed and by how much. Followed by `-k seam`,
it computes those that have "seam" in their name. Cases whose captured clips are absent keep what is stored.
"""

import pytest

from tests.frozen import store
from tests.frozen.cases import blending, editing, feet, graphs, groups, match_webs, strides  # noqa: F401
from tests.frozen.quantities import CAPTURED, CASES
from tests.refusals import quietly


@pytest.mark.parametrize("name", CASES)
def test_results_are_the_same(name, request, accepted_results):
    folder = [request.getfixturevalue("real_data")] if name in CAPTURED else []
    found = quietly(CASES[name], *folder)
    if accepted_results is not None:
        accepted_results[name] = store.accept(name, found)
    changes = store.compare(store.read(store.path_of(name)), found)
    if changes:
        pytest.fail("\n".join([f"{name} has changed:", *map(str, changes)]), pytrace=False)


def test_every_stored_result_has_a_case(accepted_results):
    orphans = set(store.FOLDER.glob("*.npz")) - set(map(store.path_of, CASES))
    if accepted_results is not None:
        for orphan in orphans:
            accepted_results[orphan.stem] = [store.Change("all", "", "", "", "", "removed: it has no case")]
            orphan.unlink()
    else:
        assert not orphans

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.methods.match_webs import build_web, local_alignment, search
from mocap.methods.match_webs.local_alignment import pieces


@given(st.lists(st.integers(1, 400), min_size=1, max_size=12), st.integers(60, 200), st.integers(0, 50))
def test_pieces_cover_all_windows_and_cut_only_clips_that_are_too_long(lengths, most, overlap):
    starts = np.cumsum([0, *lengths]).tolist()
    cut = pieces(starts, most, overlap)
    assert cut[0].start == 0 and cut[-1].stop == starts[-1]
    assert all(0 < part.stop - part.start <= most for part in cut)
    for first, second in pairwise(cut):
        if second.start in starts and second.start == first.stop:
            continue
        assert first.stop - second.start == overlap  # a part of a long clip, and the next
        assert max(n for n in starts if n <= second.start) <= first.start


def test_a_web_made_of_small_pieces_finds_what_one_piece_finds(bundled, monkeypatch):
    clips = bundled.clips[:2]
    whole = build_web(clips, below=0.05)
    monkeypatch.setattr(local_alignment, "ROWS", 400)
    monkeypatch.setattr(local_alignment, "COLUMNS", 500)
    cut = build_web(clips, below=0.05)
    assert len(whole) != len(cut)  # long paths are cut
    queries = [bundled.truth[3], bundled.truth[-1] if bundled.truth[-1][0] < 2 else bundled.truth[12]]
    seen = set()  # parts of a clip say nothing twice
    for number in np.argsort([-len(cut.path(n)[0]) for n in range(len(cut))], kind="stable"):
        cells = {tuple(cell) for cell in cut.path(int(number))[0].tolist()}
        assert len(cells & seen) <= 0.75 * len(cells)
        seen |= cells
    for number, part in queries:
        one, other = (search(web, number, part) for web in (whole, cut))
        assert len(one) == pytest.approx(len(other), abs=2)
        close = [any(a.clip == b.clip and abs(a.start - b.start) <= 12 for b in other) for a in one]
        assert np.mean(close) >= 0.95

"""What the tests of pictures share."""

import matplotlib
import pytest

matplotlib.use("agg")

import matplotlib.pyplot as plt


@pytest.fixture(autouse=True)
def no_figure_stays_open():
    yield
    plt.close("all")

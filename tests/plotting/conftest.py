"""What the tests of pictures share."""

import matplotlib

matplotlib.use("agg")

from mocap import lab


def test_a_name_is_known():
    assert lab.mine("hamilton") == "hamilton"

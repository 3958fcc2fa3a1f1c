from mocap import lab


def test_before_an_exercise_is_solved_the_packages_function_stands_in(capsys):
    hamilton = lab.mine("hamilton")
    assert hamilton([0, 1, 0, 0], [0, 0, 1, 0]).tolist() == [0, 0, 0, 1]
    assert capsys.readouterr().out == "hamilton: the package's stands in until yours passes its check.\n"

"""What the tests of formats share."""

import pytest


@pytest.fixture
def write(tmp_path):
    """Return a function that writes a file and gives its path."""

    def file(name, text):
        (tmp_path / name).write_bytes(text.encode())
        return tmp_path / name

    return file

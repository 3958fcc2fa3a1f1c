"""How a command refuses."""

from mocap.cli.main import main


def check_refused(folder, capsys, words, message):
    """Run a command that must refuse: status 2, one sentence, and a folder whose files are as they were."""
    before = contents(folder)
    assert main(words) == 2
    told = capsys.readouterr().err
    assert message in told
    assert told.startswith("mocap: ") and told.count("\n") == 1
    assert contents(folder) == before


def contents(folder):
    return {path: path.read_bytes() if path.is_file() else None for path in folder.rglob("*")}

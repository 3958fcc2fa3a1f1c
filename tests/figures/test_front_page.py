"""The pictures of the README are results of the commands below them."""

import re
from pathlib import Path

import front_page
import pytest
from PIL import Image

from mocap.cli.main import main

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text("utf-8")
CELLS = re.findall(r"!\[[^]]+\]\(figures/result_(\w+)\.png\)(.*?) \|", README)


def test_there_is_a_picture_with_a_command_for_each_result():
    assert [name for name, _ in CELLS] == list(front_page.RESULTS)
    assert all("`mocap " in cell for _, cell in CELLS)
    for name in front_page.RESULTS:
        with Image.open(ROOT / "figures" / f"result_{name}.png") as picture:
            assert picture.size == front_page.SIZE


def test_all_printed_commands_are_run_in_their_order():
    printed = [command for _, cell in CELLS for command in re.findall(r"`(mocap [^`]*)`", cell)]
    ran = [command for command in front_page.commands() if command.startswith("mocap ")]
    assert set(printed) <= set(ran)
    assert ran[0] == "mocap demo --no-film"
    assert sum(command.startswith("echo ") for command in front_page.commands()) == 3


def test_the_page_of_commands_is_linked_and_lists_all_commands(capsys):
    assert "(notebooks/COMMANDS.md)" in README
    assert main([]) == 0
    listed = re.findall(r"^  (\w+)  ", capsys.readouterr().out, re.MULTILINE)
    page = (ROOT / "notebooks" / "COMMANDS.md").read_text("utf-8")
    assert len(listed) > 15
    assert [name for name in listed if f"mocap {name}" not in page] == []


@pytest.mark.sweep
def test_the_commands_work_as_printed_in_an_empty_folder(tmp_path):
    front_page.run_commands(tmp_path)
    for show in front_page.RESULTS.values():
        assert show(tmp_path).motions

"""Runs the examples in docs/python.md and the README."""
import re
import shutil

import pytest

import halfrow
from conftest import ROOT

PAGE = ROOT / "docs/python.md"
README = ROOT / "python/halfrow/README.md"
CAMERA = "python/halfrow/examples/camera.yml"


def blocks(path):
    return re.findall(r"^```python\n(.*?)^```", path.read_text(), re.DOTALL | re.MULTILINE)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with the one file that the examples say how to get."""
    for page in (PAGE, README):
        assert CAMERA in page.read_text()
    shutil.copy(ROOT / CAMERA, tmp_path / "camera.yml")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("page", [PAGE, README], ids=["page", "readme"])
def test_the_blocks_of_a_page_run_one_after_the_other(page, folder):
    names = {}
    found = [block for block in blocks(page) if not block.startswith("# test_")]
    assert found
    for block in found:
        exec(compile(block, page.name, "exec"), names)


def test_the_test_of_the_page_passes_and_fails_with_the_board(pytester):
    (test,) = [block for block in blocks(PAGE) if block.startswith("# test_board.py")]
    pytester.makepyfile(test_board=test)
    pytester.runpytest_subprocess("--halfrow-report", "reports", "test_board.py").assert_outcomes(passed=1)
    broken = pytester.runpytest_subprocess("--halfrow-board", "mock,fault=stuck-data", "test_board.py")
    broken.assert_outcomes(failed=1)


def test_the_page_names_what_there_is():
    text = PAGE.read_text()
    types = {name for name in halfrow.__all__ if name[0].isupper() and not name.isupper()}
    functions = set(halfrow.__all__) - types - {"__version__", "VERSION", "BUILTIN_FRAMES"}
    missing = {name for name in functions | {"Lens", "Tables", "Kernel", "Corrector", "Report"} if name not in text}
    assert not missing

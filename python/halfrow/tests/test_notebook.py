"""The notebook, executed as its reader would do it. What it claims, it asserts itself."""
import nbclient
import nbformat
import pytest

from conftest import ROOT

FOLDER = ROOT / "python/halfrow/examples"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.name)
def test_a_notebook_runs(path):
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    # It is committed without outputs, which would differ between computers.
    assert not any(cell.outputs or cell.execution_count for cell in code)
    nbclient.NotebookClient(notebook, timeout=None, resources={"metadata": {"path": FOLDER}}).execute()
    outputs = [output for cell in code for output in cell.outputs]
    pictures = [output for output in outputs if "image/png" in output.get("data", {})]
    assert len(pictures) == sum("plt.show()" in cell.source for cell in code) > 0
    assert not [output for output in outputs if output.get("name") == "stderr"]


def test_there_is_one():
    assert NOTEBOOKS

"""Executes the notebooks of `examples/` from their first cell to their last, and fails at the first exception of each.

    python .ci/check_notebooks.py [--pictures DIR] [NAME ...]

Needs the package with its extra `notebooks`. The notebooks are stored without outputs. A cell whose metadata has
`"picture": "NAME"` draws a picture of the book; with `--pictures docs/src/python` it is written there as NAME.svg or NAME.png,
without it the picture has to be there. NAME ... are notebooks without their ending; left out: all.
"""

import argparse
import base64
import pathlib
import sys
import time

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

ROOT = pathlib.Path(__file__).resolve().parents[1]
SHOWN = ROOT / "docs/src/python"
LARGEST = 150_000  # bytes of a picture
SECONDS = 600  # of a cell
#: Pictures are drawings, the same bytes on every day.
SETUP = """
%config InlineBackend.figure_formats = ["svg"]
%config InlineBackend.print_figure_kwargs = {"bbox_inches": "tight", "dpi": 110, "metadata": {"Date": None}}
import matplotlib
matplotlib.rcParams["svg.hashsalt"] = "foldwell"
"""


def pictures(notebook):
    """Yields the pictures of an executed notebook: name, ending, bytes; None for the bytes of a cell that drew nothing."""
    for cell in notebook.cells:
        name = cell.metadata.get("picture")
        if name is None:
            continue
        found = [output.data for output in cell.get("outputs", []) if "data" in output]
        drawings = [data["image/svg+xml"] for data in found if "image/svg+xml" in data]
        images = [data["image/png"] for data in found if "image/png" in data]
        if drawings:
            yield name, "svg", drawings[-1].encode()
        else:
            yield name, "png", base64.b64decode(images[-1]) if images else None


def faults(path, folder):
    """Executes a notebook, writes its pictures into the folder if there is one, and yields what is wrong."""
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    if any(cell.get("outputs") or cell.get("execution_count") for cell in notebook.cells):
        yield "has outputs; they are not stored"
    notebook.cells.insert(0, nbformat.v4.new_code_cell(SETUP))
    client = NotebookClient(notebook, timeout=SECONDS, kernel_name="python3", resources={"metadata": {"path": path.parent}})
    try:
        client.execute()
    except CellExecutionError as error:
        yield str(error)
        return
    for name, ending, content in pictures(notebook):
        file = (folder or SHOWN) / f"{name}.{ending}"
        if content is None:
            yield f"the cell of the picture {name} draws nothing"
        elif len(content) > LARGEST:
            yield f"the picture {name} has {len(content)} bytes, more than {LARGEST}"
        elif folder:
            folder.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
        elif not file.exists():
            yield f"there is no {file.relative_to(ROOT)}; make it by --pictures {SHOWN.relative_to(ROOT)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--pictures", type=pathlib.Path, metavar="DIR", help="write the pictures of the book there")
    parser.add_argument("names", nargs="*", metavar="NAME")
    given = parser.parse_args()
    paths = [ROOT / f"examples/{name}.ipynb" for name in given.names] or sorted((ROOT / "examples").glob("*.ipynb"))
    failed = 0
    for path in paths:
        begin = time.monotonic()
        wrong = list(faults(path, given.pictures))
        failed += len(wrong)
        print(f"{path.stem}: {'FAILED' if wrong else 'ok'}, {time.monotonic() - begin:.1f} s", *wrong, sep="\n  ", flush=True)
    print(f"{len(paths)} notebooks, {failed} failures")
    sys.exit(1 if failed or not paths else 0)


if __name__ == "__main__":
    main()

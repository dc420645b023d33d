"""Figures do not depend on matplotlib's global state, and display themselves."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import matplotlib as mpl
import pytest
from house import CORE, imports_of
from processes import python, surroundings

from evoframe import run_study
from evoframe.analysis.drawing import Figure, default_style
from evoframe.study.plan import read_study

HOSTILE = """
text.usetex: True
text.parse_math: True
font.family: monospace
font.size: 31
font.weight: bold
figure.dpi: 17
figure.facecolor: red
figure.constrained_layout.use: True
figure.autolayout: True
savefig.dpi: 11
savefig.facecolor: blue
savefig.bbox: tight
savefig.pad_inches: 3
savefig.transparent: True
axes.facecolor: black
axes.prop_cycle: cycler('color', ['r', 'g'])
axes.grid: True
axes.formatter.use_locale: True
axes.unicode_minus: False
lines.linewidth: 9
lines.markersize: 30
patch.force_edgecolor: True
legend.frameon: True
xtick.labelsize: 40
xtick.direction: in
ytick.minor.visible: True
path.simplify_threshold: 1.0
path.sketch: 1, 100, 2
image.cmap: jet
svg.fonttype: path
svg.hashsalt: other
svg.id: mine
pdf.fonttype: 3
pdf.compression: 0
pdf.use14corefonts: True
agg.path.chunksize: 100
boxplot.notch: True
"""

DAMAGED = "no colon\nfont.size: large\nunknown.key: 1\nbackend: nonsense\naxes.prop_cycle: import os\n"

ENVIRONMENTS: Mapping[str, Mapping[str, str]] = {
    "plain": {},
    "notebook without its package": {"MPLBACKEND": "module://matplotlib_inline.backend_inline"},
    "unknown backend": {"MPLBACKEND": "nonsense"},
    "window": {"MPLBACKEND": "TkAgg"},
    "empty backend": {"MPLBACKEND": ""},
    "hostile": {"MATPLOTLIBRC": "hostile.rc"},
    "damaged": {"MATPLOTLIBRC": "damaged.rc", "MPLBACKEND": "module://nonsense"},
    "missing": {"MATPLOTLIBRC": "nowhere.rc"},
}

DRAWN = """
import sys
import evoframe
from evoframe.analysis import data, figures

study, out = sys.argv[1:]
evoframe.report(study, out=out)
shown = figures.finals(data.load_study(study).views("score")[0], "score")
with open(out + "/shown.png", "wb") as file:
    file.write(shown._repr_png_())
shown.savefig(out + "/saved.png", dpi=50)
"""

STUDY = """
extends = "quick"
runs = 5

[run]
generations = 1

[grid]
aggregator = ["am", "hm"]
"""


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("study")
    (folder / "study.toml").write_text(STUDY)
    (folder / "hostile.rc").write_text(HOSTILE)
    (folder / "damaged.rc").write_text(DAMAGED)
    run_study(read_study(folder / "study.toml"), out=folder / "study")
    return folder


def files_of(study: Path, name: str) -> dict[str, bytes]:
    """Return the files of a report that another process writes in an environment."""
    ended = subprocess.run(
        [sys.executable, "-c", DRAWN, "study", name],
        cwd=study,
        env={**surroundings(), "MPLBACKEND": "", **ENVIRONMENTS[name]},
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr
    return {path.name: path.read_bytes() for path in (study / name).iterdir()}


@pytest.fixture(scope="module")
def expected(study: Path) -> dict[str, bytes]:
    return files_of(study, "plain")


def test_all_kinds_of_figures_are_compared(expected: dict[str, bytes]) -> None:
    kinds = {name.partition("-")[0] for name in expected if name.endswith(".svg")}
    assert kinds == {"champion", "curves", "finals", "ranks"}
    assert {"report.html", "shown.png", "saved.png"} < expected.keys()


@pytest.mark.parametrize("name", [name for name in ENVIRONMENTS if name != "plain"])
def test_every_file_is_the_same_in_every_environment(
    study: Path, expected: dict[str, bytes], name: str
) -> None:
    found = files_of(study, name)
    assert found.keys() == expected.keys()
    different = {each for each in found if found[each] != expected[each]}
    assert different <= {"saved.png"}  # by the user, with own settings for files


def test_settings_that_cannot_be_read_are_an_error_with_their_name(tmp_path: Path) -> None:
    (tmp_path / "matplotlibrc").write_bytes("font.size: 3\n".encode("utf-16"))
    program = "import evoframe; evoframe.load_study('nowhere')"
    ended = python("-c", program, directory=tmp_path)
    assert "evoframe.errors.InputError: matplotlibrc: " in ended.stderr


def test_the_backend_of_the_user_remains(tmp_path: Path) -> None:
    program = (
        "import os, matplotlib\n"
        "import evoframe.analysis.figures\n"
        "print(matplotlib.rcParams._get('backend'), os.environ['MPLBACKEND'])\n"
    )
    for first in ("", "import evoframe.analysis.figures\n"):
        ended = python("-c", first + program, MPLBACKEND="svg")
        assert ended.stdout.split() == ["svg", "svg"], ended.stderr


def test_settings_of_the_user_remain(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(mpl.rcParams, "font.size", 31.0)
    before = dict(mpl.rcParams)
    with default_style(**{"lines.linewidth": 3.0}):
        assert mpl.rcParams["font.size"] == mpl.rcParamsDefault["font.size"]
        with default_style(**{"svg.hashsalt": "x"}):
            assert (mpl.rcParams["svg.hashsalt"], mpl.rcParams["lines.linewidth"]) == ("x", 3.0)
        assert mpl.rcParams["svg.hashsalt"] is None
    assert dict(mpl.rcParams) == before


def test_a_figure_displays_itself_with_its_changes() -> None:
    figure = Figure(figsize=(2.0, 1.0))
    axes = figure.add_subplot()
    plain = figure._repr_png_()
    assert plain.startswith(b"\x89PNG")
    assert figure._repr_png_() == plain
    axes.set_title("changed by the user")
    assert figure._repr_png_() != plain


@pytest.mark.parametrize("path", sorted((CORE / "analysis").rglob("*.py")), ids=lambda path: path.stem)
def test_no_module_uses_the_state_of_pyplot_or_another_figure(path: Path) -> None:
    for module, name in imports_of(path):
        assert "pyplot" not in (*module.split("."), name)
        assert module != "matplotlib.figure"
        assert (module, name) != ("matplotlib", "figure") or path.stem == "drawing"

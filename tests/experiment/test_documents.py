"""The documents and examples agree with the program."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest
from processes import python

import evoframe

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text()


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.py")), ids=lambda path: path.name)
def test_every_example_runs(path: Path, tmp_path: Path) -> None:
    ran = python(path, directory=tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout


def test_the_python_of_the_readme_runs(tmp_path: Path) -> None:
    [block] = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    ran = python("-c", block, directory=tmp_path)
    assert ran.returncode == 0, ran.stderr


def test_the_python_of_the_page_on_robustness_runs(tmp_path: Path) -> None:
    [block] = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "robustness.md").read_text(), re.DOTALL)
    ran = python("-c", block, directory=tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert (tmp_path / "robustness" / "violins.pdf").is_file()


def test_the_python_of_the_pages_on_studies_and_reports_runs(tmp_path: Path) -> None:
    blocks = {
        page: re.findall(r"```python\n(.*?)```", (ROOT / "docs" / page).read_text(), re.DOTALL)
        for page in ("studies.md", "reports.md")
    }
    [study], [report] = blocks.values()
    (tmp_path / "study.py").write_text(study)  # processes of runs import it
    (tmp_path / "report.py").write_text(report.replace("studies/paper", "studies/few"))
    for name in ("study.py", "report.py"):
        ran = python(tmp_path / name, directory=tmp_path)
        assert ran.returncode == 0, ran.stderr
    assert (tmp_path / "article" / "report.html").is_file()


def test_the_configuration_of_the_readme_is_valid(tmp_path: Path) -> None:
    [block] = re.findall(r"```toml\n(.*?)```", README, re.DOTALL)
    path = tmp_path / "mine.toml"
    path.write_text(block)
    assert evoframe.load_config(path).tables()["aggregator"]["weights"] == [0.7, 0.3]


def test_the_table_of_components_is_complete() -> None:
    rows = re.findall(r"^\| `(\S+)` \| (.*) \|$", README, re.MULTILINE)
    kinds = {
        "populations.*.encoder": "encoder",
        "populations.*.evolver": "evolver",
        "collaboration": "strategy",
        "aggregator": "aggregator",
        "simulator": "simulator",
        "objective": "objective",
        "executor": "executor",
    }
    plugins = evoframe.discover()
    listed = {key: sorted(re.findall(r"`(\S+?)`", names)) for key, names in rows if key in kinds}
    assert listed == {key: plugins.names(kind) for key, kind in kinds.items()}


def test_links_lead_to_existing_files() -> None:
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]:
        for target in re.findall(r"\]\((?!https?:)([^)#]+)\)", page.read_text()):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_the_versions_agree() -> None:
    citation = re.search(r"^version: (\S+)$", (ROOT / "CITATION.cff").read_text(), re.MULTILINE)
    assert citation is not None
    assert citation[1] == evoframe.__version__


def test_no_dependency_is_pinned_to_a_machine() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert "neat-python>=2.0,<2.1" in project["dependencies"]
    assert not [name for name in project["dependencies"] if "@" in name or "file:" in name]

"""Tests of the report of a study."""

from __future__ import annotations

import re

import attrs
import pytest
import toy_box

from evoframe import Plugins
from evoframe.analysis.data.studies import StudyData
from evoframe.analysis.data.tables import comparisons
from evoframe.analysis.output.texts import written
from evoframe.analysis.page.html import Chart, Words
from evoframe.analysis.report.study_report import draft_of_study
from evoframe.analysis.statistics.words import conclusion
from evoframe.errors import InputError
from evoframe.study.rows import Row

ROW = Row({}, 0, 1, "", "", 1.0, 1.0, 1.0, 1, 1, 1.0, "")


@pytest.fixture
def plugins() -> Plugins:
    return toy_box.installed()


def study(*averages: str, curve: tuple[float, ...] = (), runs: int = 5) -> StudyData:
    rows = [
        attrs.evolve(
            ROW,
            settings={"aggregator": average},
            run=run,
            score=place + run / 10,
            fitness=-place + run / 10,
            score_curve=curve,
            fitness_curve=curve,
        )
        for place, average in enumerate(averages)
        for run in range(runs)
    ]
    return StudyData("s", ("aggregator",), "m", len(rows) + 1, tuple(rows))


def test_the_conclusions_are_those_of_the_comparisons(plugins: Plugins) -> None:
    data = study("am", "wm")
    draft = draft_of_study(data, plugins, "none")
    lead = written("lead.txt", data=data)
    paragraphs = [f"s: {lead}"]
    for each, name in zip(comparisons(data, "none"), ("score of the best pair", "best fitness"), strict=True):
        assert each.comparison is not None
        said = conclusion(each.comparison, f"the {name}")
        paragraphs.append(f"s, {name} by aggregator: {each.comparison.ranking}\n{said}")
    assert draft.words == "\n\n".join(paragraphs) + "\n"
    assert draft.files["conclusions.txt"].decode() == draft.words
    assert draft.lead == lead


def test_rows_without_curves_are_not_drawn_over_generations(plugins: Plugins) -> None:
    without = draft_of_study(study("am", "wm"), plugins)
    assert not [name for name in without.files if name.startswith("curves")]
    having = draft_of_study(study("am", "wm", curve=(1.0, 2.0)), plugins)
    assert {f"curves-{yardstick}-s.svg" for yardstick in ("score", "fitness")} < {*having.files}
    captions = [b.caption for s in having.sections for b in s.blocks if isinstance(b, Chart)]
    assert [caption for caption in captions if "fitness" in caption and "95 %" in caption]


@pytest.mark.parametrize(
    ("groups", "runs", "reason"), [(["am"], 5, "AM"), (["am"], 1, "AM"), (["am", "wm"], 1, "at least 5 runs")]
)
def test_a_single_group_and_single_runs_are_not_tested(
    plugins: Plugins, groups: list[str], runs: int, reason: str
) -> None:
    draft = draft_of_study(study(*groups, runs=runs), plugins)
    [section] = [section for section in draft.sections if section.title == "s"]
    texts = [block.text for block in section.blocks if isinstance(block, Words)]
    assert len(texts) == 2
    for text, name in zip(texts, ("score of the best pair", "best fitness"), strict=True):
        assert name in text.lower()
        assert reason in text
    assert not re.search(r"\bp [<=>]|H =|A12", draft.words)
    assert not [name for name in draft.files if name.startswith("ranks")]


@pytest.mark.parametrize(("runs", "tested"), [(4, False), (5, True)])
def test_fewer_than_five_runs_get_no_p_value(plugins: Plugins, runs: int, tested: bool) -> None:
    draft = draft_of_study(study("am", "wm", runs=runs), plugins)
    assert bool(re.search(r"\bp [<=>]", draft.words)) == tested
    assert ("at least 5 runs" in draft.words) == (not tested)
    assert ("ranks-score-s.svg" in draft.files) == tested


def test_a_study_without_a_finished_run_is_rejected(plugins: Plugins) -> None:
    with pytest.raises(InputError) as caught:
        draft_of_study(study(), plugins)
    assert caught.value.source == "s"
    assert "evoframe study" in caught.value.problem

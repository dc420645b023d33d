"""The report of a study says of each view what its tests say, on both yardsticks."""

from __future__ import annotations

import attrs
import pytest
import toy_box

from evoframe import Plugins
from evoframe.analysis.data.studies import StudyData
from evoframe.analysis.data.tables import comparisons
from evoframe.analysis.page.html import Chart, Words
from evoframe.analysis.report.study_report import draft_of_study
from evoframe.analysis.statistics.words import conclusion
from evoframe.errors import InputError
from evoframe.study.rows import Row

ROW = Row({}, 0, 1, "", "", 1.0, 1.0, 1.0, 1, 1, 1.0, "")


@pytest.fixture
def plugins() -> Plugins:
    return toy_box.installed()


def study(*averages: str, curve: tuple[float, ...] = ()) -> StudyData:
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
        for run in range(5)
    ]
    return StudyData("s", ("aggregator",), "m", len(rows) + 1, tuple(rows))


def test_its_words_are_those_of_the_comparisons(plugins: Plugins) -> None:
    data = study("am", "wm")
    draft = draft_of_study(data, plugins, "none")
    lead = "10 of 11 runs are finished. What follows may change with the others."
    paragraphs = [f"s: {lead}"]
    for each, name in zip(comparisons(data, "none"), ("best pair simulated", "best fitness"), strict=True):
        assert each.comparison is not None
        said = conclusion(each.comparison, f"the {name}")
        paragraphs.append(f"s, {name} by aggregator: {each.comparison.ranking}\n{said}")
    assert draft.words == "\n\n".join(paragraphs) + "\n"
    assert draft.files["conclusions.txt"].decode() == draft.words
    assert draft.lead == lead


def test_what_has_no_curves_is_not_drawn_over_generations(plugins: Plugins) -> None:
    without = draft_of_study(study("am", "wm"), plugins)
    assert not [name for name in without.files if name.startswith("curves")]
    having = draft_of_study(study("am", "wm", curve=(1.0, 2.0)), plugins)
    assert {f"curves-{yardstick}-s.svg" for yardstick in ("score", "fitness")} < {*having.files}
    captions = [b.caption for s in having.sections for b in s.blocks if isinstance(b, Chart)]
    assert "Best fitness in each generation: mean over runs, with 95 % bands (bootstrap)." in captions


def test_one_group_is_alone(plugins: Plugins) -> None:
    draft = draft_of_study(study("am"), plugins)
    [section] = [section for section in draft.sections if section.title == "s"]
    assert [block.text for block in section.blocks if isinstance(block, Words)] == [
        f"The {name} by aggregator: AM is the only group, so there is nothing that it could be compared with."
        for name in ("best pair simulated", "best fitness")
    ]


def test_without_a_finished_run_there_is_nothing_to_report(plugins: Plugins) -> None:
    with pytest.raises(InputError, match="s: no run of this study is finished"):
        draft_of_study(study(), plugins)

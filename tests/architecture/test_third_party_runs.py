"""Packages of third parties: their contract tests, and runs that are interrupted and resumed."""

from __future__ import annotations

import functools
import itertools
import json
import shutil
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import pytest
import stopping
from processes import Evoframe, python
from recorded import assert_same_result, rows
from third_parties import SOURCES, installed

from evoframe import CONTRACTILE, Run, load_run

CONFIGURATIONS = {
    "archive": "archive.toml",
    "no-voxels": "throw.toml",
    "personal": "personal.toml",
    "three-objectives": "three-objectives.toml",
}
"""Name of a package -> the configuration that it contains."""

Row: TypeAlias = Mapping[str, Any]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return installed(tmp_path_factory.mktemp("third-party"), *CONFIGURATIONS)


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a directory with all configurations, and runs."""
    directory = tmp_path_factory.mktemp("runs")
    for name, configuration in CONFIGURATIONS.items():
        shutil.copy(SOURCES / name / configuration, directory)
    return directory


@pytest.fixture(scope="module")
def evoframe(site: Path, runs: Path) -> Evoframe:
    return functools.partial(python, "-m", "evoframe", directory=runs, PYTHONPATH=str(site))


@pytest.fixture(scope="module")
def finished(evoframe: Evoframe, runs: Path) -> Callable[[str], Run]:
    """Return a function that returns the uninterrupted run of a package's configuration."""

    @functools.cache
    def run(name: str) -> Run:
        ended = evoframe("run", CONFIGURATIONS[name], "--out", name)
        assert ended.returncode == 0, ended.stderr
        return load_run(runs / name)

    return run


@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_the_contract_tests_of_a_package_pass(name: str, site: Path, tmp_path: Path) -> None:
    for path in (SOURCES / "conftest.py", *(SOURCES / name).glob("test_*.py")):
        shutil.copy(path, tmp_path)
    options = ("-q", "-W", "error", "-p", "no:cacheprovider")
    ended = python("-m", "pytest", *options, tmp_path, directory=tmp_path, PYTHONPATH=str(site))
    assert ended.returncode == 0, ended.stdout
    assert " passed" in ended.stdout


@pytest.mark.parametrize("name", CONFIGURATIONS)
@pytest.mark.parametrize("turn", [1, 6])
def test_an_interrupted_run_is_resumed_bit_for_bit(
    name: str, turn: int, evoframe: Evoframe, finished: Callable[[str], Run], runs: Path
) -> None:
    whole, left = finished(name), f"{name}-left-{turn}"
    stop = evoframe(
        *("run", CONFIGURATIONS[name], "-p", stopping.__file__, "--out", left), STOPPING_AFTER_TURN=str(turn)
    )
    assert stop.returncode == 130, stop.stderr
    assert turn <= len(load_run(runs / left).workload()) - 1 < len(whole.workload()) - 1
    resumed = evoframe("resume", left)
    assert resumed.returncode == 0, resumed.stderr
    assert_same_result(whole.directory, runs / left)
    assert rows(whole.directory, "measures") == rows(runs / left, "measures")


@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_a_run_records_the_distribution_and_can_be_checked(
    name: str, evoframe: Evoframe, finished: Callable[[str], Run]
) -> None:
    directory = finished(name).directory
    assert f"'{name}' of acme-{name} " in (directory / "config.toml").read_text()
    checked = evoframe("doctor", "--json", name)
    assert checked.returncode == 0, checked.stderr
    assert {check["state"] for check in json.loads(checked.stdout)[name]} == {"ok"}


def by_turn(found: Sequence[Row]) -> dict[int, list[Row]]:
    """Return rows of a table for each turn."""
    return {turn: list(group) for turn, group in itertools.groupby(found, key=lambda row: row["turn"])}


def evaluated(run: Run) -> list[tuple[int, str, list[Row]]]:
    """Return all evaluations after the initial turn: turn, population, and its individuals."""
    found = by_turn(run.individuals())
    return [(turn, found[turn][0]["population"], found[turn]) for turn in found if turn > 0]


def members_before(run: Run, turn: int, population: str) -> list[Row]:
    """Return the individuals of a population as they are when another one is evaluated."""
    earlier = [row for row in run.individuals() if row["population"] == population and row["turn"] < turn]
    return [row for row in earlier if row["turn"] == earlier[-1]["turn"]]


def test_record_holders_meet_others_after_they_have_left(finished: Callable[[str], Run]) -> None:
    """The archive, computed again from the table of pairs."""
    run = finished("archive")
    evaluations = {turn: population for turn, population, _ in evaluated(run)}
    record, holders, departed = -float("inf"), {"x": list[int](), "y": list[int]()}, 0
    for turn, pairs in by_turn(run.pairs()).items():
        if turn in evaluations:
            other = "y" if evaluations[turn] == "x" else "x"
            met = {pair[other] for pair in pairs}
            present = members_before(run, turn, other)
            assert len(met) == 2
            assert met >= set(holders[other][-2:])
            departed += len(met - {member["genome_id"] for member in present})
        best = max(pairs, key=lambda pair: pair["score"])
        if best["score"] > record:
            record = best["score"]
            for role, ids in holders.items():
                ids[:] = [*(id_ for id_ in ids if id_ != best[role]), best[role]]
    assert departed > 0


def test_each_individual_meets_strangers_when_it_has_settled(finished: Callable[[str], Run]) -> None:
    run = finished("personal")
    pairs, last_met = by_turn(run.pairs()), dict[tuple[str, int], set[int]]()
    kept, changed, from_two_species = 0, 0, 0
    for turn, population, individuals in evaluated(run):
        other = "controller" if population == "morphology" else "morphology"
        members = members_before(run, turn, other)
        species = {member["genome_id"]: member["species"] for member in members}
        assert not any(member["diverged"] for member in members)
        for individual in individuals:
            id_ = individual["genome_id"]
            met = {pair[other] for pair in pairs[turn] if pair[population] == id_}
            known = last_met.get((population, id_), set()) & species.keys()
            strangers = species.keys() - known
            preferred = known if individual["age"] <= 1 else strangers
            if len(preferred) >= 2:
                assert met <= preferred
                kept += preferred is known
                changed += preferred is strangers and bool(known)
                if len({species[one] for one in preferred}) >= 2:
                    assert len({species[one] for one in met}) == 2
                    from_two_species += 1
            last_met[population, id_] = met
    assert min(kept, changed, from_two_species) > 0


def dominators(members: Sequence[tuple[float, ...]]) -> list[int]:
    """Return how many members are nowhere worse than a member, and different."""
    return [sum(one != other and all(map(float.__ge__, one, other)) for one in members) for other in members]


def test_members_that_few_dominate_survive(finished: Callable[[str], Run]) -> None:
    run, role = finished("three-objectives"), "morphology"
    measured = {
        (turn, position, name): value
        for turn, population, position, name, value in rows(run.directory, "measures")
        if population == role
    }
    generations = [
        [row for row in found if row["population"] == role] for found in by_turn(run.individuals()).values()
    ]
    successions = list(itertools.pairwise(filter(None, generations)))
    fitness_alone = 0
    for members, successors in successions:
        objectives = [
            (
                row["fitness"],
                -measured[row["turn"], row["position"], "age"],
                -measured[row["turn"], row["position"], "count-contractile"],
            )
            for row in members
        ]
        assert [-age for _, age, _ in objectives] == [row["age"] for row in members]
        ranks = dominators(objectives)
        order = sorted(range(len(members)), key=lambda index: (ranks[index], index))
        survivors = {members[index]["genome_id"] for index in order[: len(members) // 2]}
        assert survivors <= {row["genome_id"] for row in successors}
        fittest = sorted(members, key=lambda row: -row["fitness"])[: len(survivors)]
        fitness_alone += survivors == {row["genome_id"] for row in fittest}
    assert len(successions) == 6
    assert fitness_alone < len(successions)


def test_measures_are_those_of_the_designs(finished: Callable[[str], Run]) -> None:
    run = finished("three-objectives")
    best = json.loads(run.table("best_pairs")[-1]["document"])
    genome, body = best["genome_ids"]["morphology"], run.champion().design.roles["morphology"]
    places = {
        (row["turn"], row["position"])
        for row in run.individuals()
        if (row["population"], row["genome_id"]) == ("morphology", genome)
    }
    values = {
        value
        for turn, population, position, name, value in rows(run.directory, "measures")
        if (population, name) == ("morphology", "count-contractile") and (turn, position) in places
    }
    assert values == {float((body == CONTRACTILE).sum())}


@pytest.mark.parametrize(
    ("source", "setting", "key", "missing"),
    [
        (
            "three-objectives.toml",
            'populations.morphology.evolver.minimize=["age", "beauty"]',
            "populations.morphology.evolver",
            "beauty",
        ),
        ("functions", "populations.x.evolver=domination", "populations.x.evolver", "count-contractile"),
    ],
)
def test_a_measure_that_nothing_supplies_is_refused_before_anything_runs(
    evoframe: Evoframe, runs: Path, source: str, setting: str, key: str, missing: str
) -> None:
    refused = evoframe("run", source, "--set", setting, "--out", "refused")
    assert refused.returncode == 2
    [error] = [line for line in refused.stderr.splitlines() if line.startswith("Error: ")]
    assert f"{key}: wants the measure '{missing}', which nothing supplies; supplied: age, " in error
    assert not (runs / "refused").exists()


def test_a_single_population_has_one_score_for_each_individual(finished: Callable[[str], Run]) -> None:
    run = finished("no-voxels")
    scores = {(pair["turn"], pair["throw"]): pair["score"] for pair in run.pairs()}
    fitness = {(row["turn"], row["genome_id"]): row["fitness"] for row in run.individuals()}
    assert scores == fitness
    assert set(run.champion().design.roles) == {"throw"}


def test_a_report_without_geometry_has_curves_and_a_page(
    evoframe: Evoframe, finished: Callable[[str], Run]
) -> None:
    directory = finished("no-voxels").directory
    reported = evoframe("report", "no-voxels")
    assert reported.returncode == 0, reported.stderr
    assert "best pair" in reported.stdout
    names = {path.name for path in (directory / "report").iterdir()}
    assert {"report.html", "curves.svg", "summary.csv"} <= names
    assert not any(name.startswith("champion-body") for name in names)


def test_worker_processes_find_an_installed_simulator(
    evoframe: Evoframe, finished: Callable[[str], Run], runs: Path
) -> None:
    other = evoframe(
        "run", "throw.toml", "--set", 'executor={name="processes", workers=2}', "--out", "others"
    )
    assert other.returncode == 0, other.stderr
    assert_same_result(finished("no-voxels").directory, runs / "others")

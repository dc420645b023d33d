"""The published experiment with its real components, shortened; `make run` runs the whole experiment."""

from __future__ import annotations

import contextlib
import hashlib
import json
import math
import random
import sqlite3
import statistics
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from loops import continued, history, stopped
from processes import python
from recorded import assert_same_result

import evoframe
from evoframe import Run

WEIGHTS = {2: (0.6, 0.4), 3: (0.5, 0.3, 0.2), 5: (0.4, 0.3, 0.15, 0.1, 0.05)}


def weighted(scores: list[float]) -> float:
    ordered = sorted(scores, reverse=True)
    return math.fsum(w * s for w, s in zip(WEIGHTS[len(scores)], ordered, strict=True))


def floored(mean: Callable[[list[float]], float]) -> Callable[[list[float]], float]:
    return lambda scores: mean([1e-5 if score <= 0 else score for score in scores])


MEANS: dict[str, Callable[[list[float]], float]] = {
    "am": statistics.fmean,
    "wm": weighted,
    "gm": floored(statistics.geometric_mean),
    "hm": floored(statistics.harmonic_mean),
}


@pytest.fixture(scope="module")
def short(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Three generations of the paper's run, with its full populations."""
    return evoframe.run("paper", out=tmp_path_factory.mktemp("short") / "run", run={"generations": 3})


class TestRecord:
    def test_the_initial_meeting_has_625_pairs_and_each_turn_50(self, short: Run) -> None:
        counts = [sum(row["turn"] == turn for row in short.pairs()) for turn in range(7)]
        assert counts == [625, *[50] * 6]

    def test_populations_keep_their_size(self, short: Run) -> None:
        for turn in short.turns():
            members = [
                row
                for row in short.individuals()
                if (row["turn"], row["population"]) == (turn["turn"], turn["population"])
            ]
            assert len({member["genome_id"] for member in members}) == 25

    @pytest.mark.parametrize("aggregator", MEANS)
    @pytest.mark.parametrize("n", [2, 5])
    def test_fitness_follows_from_the_stored_scores(self, aggregator: str, n: int, tmp_path: Path) -> None:
        finished = evoframe.run(
            "quick",
            out=tmp_path / "run",
            aggregator=aggregator,
            collaboration={"n": n},
            run={"generations": 2},
        )
        pairs = finished.pairs()
        for individual in finished.individuals():
            scores = [
                pair["score"]
                for pair in pairs
                if pair["turn"] == individual["turn"]
                and pair[individual["population"]] == individual["genome_id"]
            ]
            mean = statistics.fmean if individual["turn"] == 0 else MEANS[aggregator]
            assert individual["fitness"] == pytest.approx(mean(scores), rel=1e-12)

    def test_the_champion_is_enclosed_and_uses_the_codes_of_the_authors(self, short: Run) -> None:
        body = short.champion().design.roles["morphology"]
        assert body.shape == (20, 8, 8)
        interior = body[1:-1, 1:-1, 1:-1].copy()
        assert set(np.unique(interior)) <= {0, 1, 3}
        shell = body.copy()
        shell[1:-1, 1:-1, 1:-1] = 1
        assert (shell == 1).all()

    def test_the_champion_is_verified_and_exported_for_the_original_engine(self, short: Run) -> None:
        verification = short.verification()
        assert verification is not None
        assert verification.unchanged.value == short.champion().score
        shares = {finding.name: verification.share(finding) for finding in verification.findings}
        assert len(shares) == 5
        assert shares["contraction off"] is not None
        assert (short.directory / "champion.vxa").read_bytes().startswith(b"<?xml")


# Columns of tables; digests of their rows and of the file of the champion. A change that is not to change
# results keeps them; another one is named in CHANGELOG.md.
COLUMNS = {
    "turns": "turn, population, generation, best, best_so_far, standing_champion, mean",
    "individuals": "turn, population, position, genome_id, species, genome_size, age, fitness, diverged",
    "pairs": "turn, pair, morphology, controller, score, diverged_at",
}
DIGESTS = {
    "turns": "6f14f1087d6e9358",
    "individuals": "1084ca664b49faee",
    "pairs": "9a153f2bbcbd2b8d",
    "champion.json": "1c0ddcde63e66306",
}


def statement(table: str) -> str:
    return f"SELECT {COLUMNS[table]} FROM {table}"  # noqa: S608 - constants


def digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]


class TestDeterminism:
    def test_three_generations_have_the_same_bits_as_before_populations_had_own_components(
        self, short: Run
    ) -> None:
        """The digests are those of commit 85d1fba."""
        with contextlib.closing(sqlite3.connect(short.directory / "run.db")) as database:
            found = {
                table: digest(json.dumps(database.execute(statement(table)).fetchall()).encode())
                for table in COLUMNS
            }
        found["champion.json"] = digest((short.directory / "champion.json").read_bytes())
        assert found == DIGESTS

    def test_a_second_run_gives_the_same_result(self, short: Run, tmp_path: Path) -> None:
        again = evoframe.run("paper", out=tmp_path / "again", run={"generations": 3})
        assert_same_result(short.directory, again.directory)

    @pytest.mark.parametrize(("workers", "hash_seed"), [("1", "0"), ("2", "1"), ("3", "12345")])
    def test_workers_and_hash_seed_do_not_change_the_result(
        self, short: Run, tmp_path: Path, workers: str, hash_seed: str
    ) -> None:
        directory = tmp_path / "run"
        command = ["run", "--set", "run.generations=3", "--workers", workers, "--out", str(directory)]
        ran = python("-m", "evoframe", "-q", *command, PYTHONHASHSEED=hash_seed)
        assert ran.returncode == 0, ran.stderr
        assert_same_result(short.directory, directory)

    def test_two_runs_interleaved_equal_each_alone(self) -> None:
        def coevolution(seed: int) -> evoframe.Coevolution:
            return evoframe.assemble(evoframe.load_config("quick", overrides=[f"run.seed={seed}"]))

        together = [list(pair) for pair in zip(coevolution(1), coevolution(2), strict=True)]
        assert history([first for first, _ in together]) == history(coevolution(1))
        assert history([second for _, second in together]) == history(coevolution(2))

    @pytest.mark.parametrize("at", [0, 1, 4])
    def test_a_restored_loop_continues_bit_for_bit(self, at: int) -> None:
        config = evoframe.load_config("quick", overrides=["collaboration=random"])
        whole = history(evoframe.assemble(config))
        assert history(continued(config, stopped(config, at))) == whole[at + 1 :]


class TestSwaps:
    @pytest.mark.parametrize(
        "settings",
        [
            {"aggregator": "hm"},
            {"collaboration.n": 5},
            {"collaboration": "worst"},
            {"collaboration": "random"},
            {"collaboration": "best-and-worst", "aggregator": "am"},
            {"collaboration": {"name": "best-and-worst", "n": 2}, "aggregator": {"name": "wm", "fold": True}},
            {"collaboration.n": 4, "aggregator": {"name": "wm", "weights": [0.4, 0.3, 0.2, 0.1]}},
            {"objective": "tip-yz"},
            {"objective": "face-yz"},
            {"objective": {"name": "face-peak", "after": 0.02}},
            {"objective": {"name": "travel", "along": "-y", "every": 0.01}},
            {"simulator.phase_unit": "radians"},
            {"populations.morphology.evolver": "random", "populations.controller.evolver": "random"},
            {"populations.morphology.encoder.enclosure": False},
            {"populations.morphology.encoder.canvas": [6, 4, 4]},
            {"executor": "serial"},
        ],
        ids=str,
    )
    def test_each_runs(self, settings: dict[str, Any], tmp_path: Path) -> None:
        finished = evoframe.run("quick", out=tmp_path / "run", **{"run.generations": 1, **settings})
        assert math.isfinite(finished.champion().score)

    def test_a_file_with_weights_runs(self, tmp_path: Path) -> None:
        path = tmp_path / "mine.toml"
        path.write_text('extends = "quick"\n[aggregator]\nname = "wm"\nweights = [0.7, 0.3]\n')
        finished = evoframe.run(path, out=tmp_path / "run")
        assert finished.config["aggregator"]["weights"] == [0.7, 0.3]


def numpy_state() -> dict[str, Any]:
    """Return the state of numpy's global stream, with its array as a list."""
    found = np.random.get_state(legacy=False)  # noqa: NPY002
    return {**found, "state": {**found["state"], "key": found["state"]["key"].tolist()}}


def test_the_global_random_states_are_not_changed(tmp_path: Path) -> None:
    random.seed(5)
    np.random.seed(5)  # noqa: NPY002 - the global stream must not change
    before = random.getstate(), numpy_state()
    evoframe.run("quick", out=tmp_path / "run", run={"generations": 1})
    assert (random.getstate(), numpy_state()) == before

"""Selection of bodies, and refusal of those that cannot be compared."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import attrs
import numpy as np
import pytest
import toys

from evoframe import ConfigurationError, Design, InputError, Plugins, run
from evoframe.config import read_layers
from evoframe.contract.config import RunConfig
from evoframe.robustness.candidates import Candidates, read_candidates
from evoframe.study.conduct import claim
from evoframe.study.plan import read_study

STEERED = "simulator=toy-steered"
STUDY = """
extends = "toy.toml"
runs = 2
simulator = "toy-steered"

[run]
seed = 7

[grid]
"collaboration.n" = [1, 2]
aggregator = ["toy-mean"]
"""

Read = Callable[..., Candidates]


@pytest.fixture
def read(here: Path, toy_file: Path, toy_plugins: Plugins) -> Read:
    def read_them(
        *sources: str, preset: str | None = None, overrides: Sequence[str] = (), published: bool = False
    ) -> Candidates:
        paths = [Path(source) for source in sources]
        base = None if preset is None else read_layers(preset)
        return read_candidates(paths, base, overrides, toy_plugins, published=published)

    return read_them


def make_study(directory: str, plugins: Plugins, finished: int = 4, executor: str = "toy-here") -> None:
    Path("study.toml").write_text(f'executor = "{executor}"\n{STUDY}')
    study = read_study("study.toml", (), plugins)
    claim(study, Path(directory))
    for planned in list(study.planned(Path(directory)))[:finished]:
        config = planned.cell.config
        seeded = attrs.evolve(config, run=attrs.evolve(config.run, seed=planned.seed))
        run(seeded, out=planned.directory)


def labels(candidates: Candidates) -> list[str]:
    return [body.label for body in candidates.bodies]


class TestRuns:
    def test_stand_for_their_champions(self, read: Read, two_runs: list[str]) -> None:
        found = read(*two_runs)
        assert [(body.label, body.group) for body in found.bodies] == [(name, name) for name in two_runs]
        assert found.config.simulator.name == "toy-steered"

    def test_can_be_combined_with_published_bodies(self, read: Read, two_runs: list[str]) -> None:
        assert labels(read("run-1", published=True)) == ["run-1", "one", "two"]

    def test_with_another_simulation_are_refused(
        self, read: Read, toy_config: Callable[..., RunConfig], two_runs: list[str]
    ) -> None:
        run(toy_config("simulator={name='toy-steered', gain=2.0}"), out="other")
        with pytest.raises(InputError) as caught:
            read("run-1", "other")
        assert caught.value.source == "other"
        first, second = caught.value.problem.splitlines()
        assert all(data in first for data in ("run-1", "--preset", "--set"))
        assert second == "  simulator.gain: 1.0 in run-1, 2.0 in other"
        assert labels(read("run-1", "other", overrides=["simulator.gain=3.0"])) == ["run-1", "other"]
        assert labels(read("run-1", "other", preset="toy.toml", overrides=[STEERED])) == ["run-1", "other"]

    def test_that_are_named_twice_are_refused(self, read: Read, two_runs: list[str]) -> None:
        with pytest.raises(InputError, match="'run-1' already") as caught:
            read("run-1", "run-2", "run-1")
        assert caught.value.source == "run-1"

    def test_that_are_damaged_are_refused(self, read: Read, two_runs: list[str]) -> None:
        Path("run-2/run.db").write_bytes(b"no database")
        with pytest.raises(InputError, match=r"run-2/run.db"):
            read(*two_runs)

    def test_that_are_missing_are_refused(self, read: Read, two_runs: list[str]) -> None:
        with pytest.raises(InputError, match=r"^nowhere: .*No such file"):
            read("run-1", "nowhere")
        with pytest.raises(InputError, match="embedded null"):
            read("run-1", "no\0where")


class TestFiles:
    @pytest.fixture(autouse=True)
    def files(self, here: Path) -> None:
        Path("two.toy").write_text("designs = [{ a = 2.0, b = 3.0 }, { a = -1.0, b = 1.0 }]\n")

    def test_have_bodies_with_the_names_that_the_simulator_gives(self, read: Read) -> None:
        found = read("two.toy", preset="toy.toml", overrides=[STEERED])
        assert labels(found) == ["two.toy[0]", "two.toy[1]"]
        assert [body.source for body in found.bodies] == ["two.toy", "two.toy"]

    def test_without_a_role_are_refused(self, read: Read) -> None:
        Path("two.toy").write_text("designs = [{ a = 2.0, b = 3.0 }, { a = -1.0 }]\n")
        with pytest.raises(InputError) as caught:
            read("two.toy", preset="toy.toml", overrides=[STEERED])
        assert (caught.value.source, caught.value.key) == ("two.toy", "two.toy[1]")
        assert caught.value.problem == "missing b"

    def test_with_another_canvas_are_refused(self, read: Read, monkeypatch: pytest.MonkeyPatch) -> None:
        def longer(simulator: toys.Varied, path: Path) -> list[tuple[str, Design]]:
            length = 2 if path.name == "other.toy" else 1
            return [(path.name, Design(dict.fromkeys("ab", np.ones(length))))]

        monkeypatch.setattr(toys.Varied, "read", longer)
        Path("other.toy").write_text("")
        with pytest.raises(InputError) as caught:
            read("two.toy", "other.toy", preset="toy.toml", overrides=[STEERED])
        assert (caught.value.source, caught.value.key) == ("other.toy", "a")
        for data in ("[2]", "[1] in two.toy"):
            assert data in caught.value.problem


class TestStudies:
    def test_stand_for_the_champions_of_each_configuration(self, read: Read, toy_plugins: Plugins) -> None:
        make_study("s", toy_plugins, 3)
        found = read("s")
        assert [(body.group, body.label) for body in found.bodies] == [
            ("toy-mean (n = 1)", "s/collaboration.n=1/aggregator=toy-mean/00"),
            ("toy-mean (n = 1)", "s/collaboration.n=1/aggregator=toy-mean/01"),
            ("toy-mean (n = 2)", "s/collaboration.n=2/aggregator=toy-mean/00"),
        ]

    def test_have_names_if_there_are_several(
        self, read: Read, toy_plugins: Plugins, two_runs: list[str]
    ) -> None:
        make_study("s", toy_plugins, 1)
        make_study("t", toy_plugins, 1)
        found = read("s", "run-1", "t")
        groups = [body.group for body in found.bodies]
        assert groups == ["s: toy-mean (n = 1)", "run-1", "t: toy-mean (n = 1)"]

    def test_have_the_workers_of_the_study_and_not_of_each_run(
        self, read: Read, toy_plugins: Plugins
    ) -> None:
        make_study("s", toy_plugins, 1, executor="toy-many")
        path = Path("s/collaboration.n=1/aggregator=toy-mean/00")
        text = (path / "config.toml").read_text().replace("workers = 4", "workers = 1")
        (path / "config.toml").write_text(text)  # as a worker of a study writes it
        assert read(str(path)).config.executor.component == toys.Many(1)
        assert read("s").config.executor.component == toys.Many(4)
        assert read("s", overrides=["executor.workers=2"]).config.executor.component == toys.Many(2)

    def test_without_a_finished_run_are_refused(self, read: Read, toy_plugins: Plugins) -> None:
        make_study("s", toy_plugins, 0)
        with pytest.raises(InputError, match="no champions") as caught:
            read("s")
        assert caught.value.source == "s"

    def test_with_a_damaged_run_are_refused(self, read: Read, toy_plugins: Plugins) -> None:
        make_study("s", toy_plugins, 2)
        Path("s/collaboration.n=2/aggregator=toy-mean/00/run.db").write_bytes(b"no database")
        with pytest.raises(InputError, match=r"00/run.db"):
            read("s")


class TestPublished:
    def test_bodies_alone_are_simulated_with_the_preset(self, read: Read) -> None:
        assert labels(read(preset="toy.toml", overrides=[STEERED], published=True)) == ["one", "two"]

    def test_bodies_are_required(self, read: Read) -> None:
        with pytest.raises(ConfigurationError, match=r"'toy-varied'.*--published"):
            read(preset="toy.toml", overrides=["simulator=toy-varied"], published=True)


def test_a_body_is_required(read: Read) -> None:
    with pytest.raises(InputError, match="--published"):
        read()


def test_a_simulator_without_random_controllers_is_refused(
    read: Read, toy_config: Callable[..., RunConfig]
) -> None:
    run(toy_config(), out="here")
    with pytest.raises(ConfigurationError, match=r"'toy-product'.*random controllers"):
        read("here")

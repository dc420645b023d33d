"""The provenance of a run is reproducible, and can be written to a file."""

from __future__ import annotations

import platform
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, ClassVar

import attrs
import numpy as np
import pytest
import toys

import evoframe
from evoframe import Chosen, Run, RunConfig, Source
from evoframe.documents.trees import as_read, differences
from evoframe.record.provenance import (
    changed_generations,
    changed_provenance,
    changed_scoring,
    provenance_of,
    recorded_generations,
)

Load = Callable[..., RunConfig]


@attrs.frozen
class Versioned(toys.Product):
    """A simulator that reports the version of its library."""

    version: str = "1.2"

    def provenance(self) -> Mapping[str, str]:
        return {"libtoy": self.version}


@attrs.frozen
class Changed(toys.Product):
    """A simulator whose results are of its second generation."""

    bit_generation: ClassVar[int] = 2


def simulated_by(config: RunConfig, simulator: toys.Product, version: str = "1.0") -> RunConfig:
    return attrs.evolve(
        config, simulator=Chosen("toy-versioned", simulator, Source("toy-box", version, "toys"))
    )


def test_has_the_versions_and_the_source_of_each_component(toy_config: Load) -> None:
    found = provenance_of(toy_config())
    assert found["evoframe"] == evoframe.__version__
    assert found["machine"] == platform.machine()
    assert found["libraries"] == {"python": platform.python_version(), "numpy": np.__version__}
    assert found["components"] == dict.fromkeys(
        [key for key, _ in toy_config().components()], "'toys' of toy-box 1.0"
    )


def test_is_the_same_each_time_and_after_it_was_read(toy_config: Load) -> None:
    found = provenance_of(toy_config())
    assert provenance_of(toy_config()) == found == as_read(found)


def test_has_the_entries_of_components(toy_config: Load) -> None:
    config = simulated_by(toy_config(), Versioned())
    assert provenance_of(config)["libraries"]["libtoy"] == "1.2"


def test_has_the_checksums_of_local_plugins_that_determine_the_result(toy_config: Load) -> None:
    config = toy_config()
    mine = Source("mine", "local", "mine", "sha256:ab")
    other = Source("workers", "local", "workers", "sha256:cd")
    local = attrs.evolve(
        config,
        aggregator=attrs.evolve(config.aggregator, source=mine),
        executor=attrs.evolve(config.executor, source=other),
    )
    assert provenance_of(local)["local_plugins"] == {"mine": "sha256:ab"}
    assert "local_plugins" not in provenance_of(config)


def test_a_run_without_checksums_of_local_plugins_is_compared_without_them(
    toy_config: Load, tmp_path: Path
) -> None:
    config = toy_config()
    mine = Source("mine", "local", "mine", "sha256:ab")
    local = attrs.evolve(config, aggregator=attrs.evolve(config.aggregator, source=mine))
    then = provenance_of(local)
    for recorded, changes in (
        (then, []),
        (
            {**then, "local_plugins": {"mine": "sha256:cd"}},
            ["local_plugins.mine: 'sha256:cd' then, 'sha256:ab' now"],
        ),
        ({key: value for key, value in then.items() if key != "local_plugins"}, []),
    ):
        assert changed_provenance(Run(tmp_path, {"provenance": recorded}), local) == changes


def test_another_version_of_a_plugin_or_of_its_library_is_a_difference(toy_config: Load) -> None:
    then = provenance_of(simulated_by(toy_config(), Versioned()))
    now = provenance_of(simulated_by(toy_config(), Versioned(version="1.3"), "2.0"))
    assert differences(then, now) == [
        "libraries.libtoy: '1.2' then, '1.3' now",
        "components.simulator: \"'toys' of toy-box 1.0\" then, \"'toys' of toy-box 2.0\" now",
    ]


def of(tmp_path: Path, recorded: Mapping[str, Any]) -> Run:
    return Run(tmp_path, {"provenance": recorded})


class TestBitGenerations:
    def test_are_recorded_for_components_that_state_one(self, toy_config: Load, tmp_path: Path) -> None:
        config = simulated_by(toy_config(), Changed())
        found = provenance_of(config)
        assert found["bit_generations"] == {"simulator": 2}
        assert recorded_generations(of(tmp_path, found)) == {"simulator": 2}
        assert "bit_generations" not in provenance_of(toy_config())

    def test_of_an_executor_do_not_count(self, toy_config: Load, tmp_path: Path) -> None:
        class Numbered(toys.Here):
            bit_generation: ClassVar[int] = 2

        config = toy_config()
        config = attrs.evolve(config, executor=attrs.evolve(config.executor, component=Numbered()))
        assert "bit_generations" not in provenance_of(config)
        assert not changed_generations(of(tmp_path, {}), config)

    def test_that_changed_are_named_once(self, toy_config: Load, tmp_path: Path) -> None:
        config = simulated_by(toy_config(), Changed())
        then = {**provenance_of(config), "bit_generations": {"simulator": 1}}
        line = "bit generation of simulator 'toy-versioned': 1 then, 2 now"
        assert changed_generations(of(tmp_path, then), config) == {"simulator": line}
        assert changed_provenance(of(tmp_path, then), config) == [line]
        assert changed_scoring(of(tmp_path, then), config) == line

    @pytest.mark.parametrize(
        "recorded", [{}, {"bit_generations": 3}, {"bit_generations": {"simulator": "2"}}]
    )
    def test_are_1_if_none_are_recorded(
        self, toy_config: Load, tmp_path: Path, recorded: Mapping[str, Any]
    ) -> None:
        """Runs of earlier versions of evoframe have none, and people edit the table."""
        assert recorded_generations(of(tmp_path, recorded)) == {}
        assert not changed_generations(of(tmp_path, recorded), toy_config())
        assert [*changed_generations(of(tmp_path, recorded), simulated_by(toy_config(), Changed()))] == [
            "simulator"
        ]

    def test_of_a_component_that_no_longer_states_one_have_changed(
        self, toy_config: Load, tmp_path: Path
    ) -> None:
        then = {**provenance_of(toy_config()), "bit_generations": {"populations.a.evolver": 2}}
        [line] = changed_provenance(of(tmp_path, then), toy_config())
        assert line.endswith("populations.a.evolver 'toy-drift': 2 then, 1 now")
        assert changed_scoring(of(tmp_path, then), toy_config()) == ""

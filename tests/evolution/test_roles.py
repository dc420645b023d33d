"""Tests of the roles of designs that no population evolves: when they are drawn, and their errors."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import toys
from toy_capabilities import Constant, Random

from evoframe import ConfigurationError, Design, InputError, Record, RunConfig, Turn, assemble
from evoframe.errors import ComponentError
from evoframe.evolution.randomness import stream
from evoframe.evolution.roles import Role, Roles

Variant = Callable[..., RunConfig]


def role(draw: str, provider: Constant | None = None, name: str = "r") -> Role:
    chosen = provider or Random()
    return Role(name, chosen, chosen, draw, seed=7)


def drawn(roles: Roles, individual: str, turn: int) -> float:
    roles.begin_turn(turn)
    return float(roles.after(roles.before(individual), individual).roles["r"][0])


class TestDraws:
    def test_once_in_a_run(self) -> None:
        roles = Roles((role("run"),))
        assert {drawn(roles, name, turn) for name in ("a 1", "a 2") for turn in range(3)} == {
            stream(7, "role/r").random()
        }
        assert not roles.are_redrawn

    def test_once_in_a_turn(self) -> None:
        roles = Roles((role("turn"),))
        for turn in range(3):
            assert drawn(roles, "a 1", turn) == drawn(roles, "a 2", turn)
        assert len({drawn(roles, "a 1", turn) for turn in range(3)}) == 3
        assert drawn(roles, "a 1", 2) == stream(7, "role/r/2").random()
        assert roles.are_redrawn

    def test_for_each_individual_in_each_turn(self) -> None:
        roles = Roles((role("individual"),))
        assert len({drawn(roles, name, turn) for name in ("a 1", "a 2") for turn in range(3)}) == 6
        assert drawn(roles, "a 1", 2) == drawn(roles, "a 1", 2) == stream(7, "role/r/2/a 1").random()

    def test_of_two_roles_are_independent(self) -> None:
        first, second = role("run"), role("run", Random("s"), "s")
        design = Roles((first, second)).before("a 1")
        assert design.roles["r"][0] != design.roles["s"][0]


class TestOrder:
    def test_roles_without_requirements_come_first(self) -> None:
        before, after = role("run", Constant("r", 1.0)), role("run", Constant("s", 2.0, ("r",)), "s")
        roles = Roles((after, before))
        assert set(roles.before("a 1").roles) == {"r"}
        complete = roles.after(roles.before("a 1"), "a 1")
        assert {name: float(array[0]) for name, array in complete.roles.items()} == {"r": 1.0, "s": 2.0}

    def test_equal_arguments_give_the_same_object_in_a_turn(self) -> None:
        """Designs are compared by identity, so that equal ones are simulated once."""
        roles = Roles((role("turn"),))
        first = roles.before("a 1")
        assert roles.before("a 2") is first
        roles.begin_turn(1)
        assert roles.before("a 1") is not first


class TestRuns:
    @staticmethod
    def genomes(config: RunConfig) -> list[tuple[Turn, dict[int, float]]]:
        coevolution = assemble(config)
        [population] = coevolution.populations
        return [
            (turn, {m.id: g for m, g in zip(population.members, population.genomes, strict=True)})
            for turn in coevolution
        ]

    @pytest.mark.parametrize(
        ("name", "drawn_for"),
        [
            ("one with a role for each", "/{turn}/a {id}"),
            ("one with a role after it", "/{turn}/a {id}"),
            ("one with a role for each turn", "/{turn}"),
        ],
    )
    def test_scores_are_those_with_the_drawn_number(
        self, toy_variant: Variant, name: str, drawn_for: str
    ) -> None:
        for turn, genomes in self.genomes(toy_variant(name)):
            for pair in turn.pairs:
                [key] = pair.genomes
                number = stream(3, f"role/r{drawn_for.format(turn=turn.index, id=key)}").random()
                assert pair.score == pytest.approx(genomes[key] * number, rel=1e-12)

    def test_survivors_are_simulated_again_if_the_role_is_drawn_again(self, toy_variant: Variant) -> None:
        coevolution = assemble(toy_variant("one with a role for each turn"))
        scores: dict[tuple[int, ...], set[float | None]] = {}
        for turn in coevolution:
            for pair in turn.pairs:
                scores.setdefault(pair.genomes, set()).add(pair.score)
        assert any(len(each) > 1 for each in scores.values())

    def test_with_several_populations_individuals_are_those_that_reproduced(
        self, toy_variant: Variant, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        designs: list[Design] = []
        simulate = toys.Product.simulate

        def noted(self: Any, given: Any, record: Record) -> Any:
            designs.extend(given)
            return simulate(self, given, record)

        monkeypatch.setattr(toys.Product, "simulate", noted)
        for turn in assemble(toy_variant("roles in turns")):
            judged = turn.reports[0].population if turn.reports else "a"
            column = "ab".index(judged)
            names = {f"{judged} {pair.genomes[column]}" for pair in turn.pairs}
            expected = {stream(3, f"role/r/{turn.index}/{name}").random() for name in names}
            assert {float(design.roles["r"][0]) for design in designs} <= expected
            designs.clear()


class TestErrors:
    @pytest.mark.parametrize("method", ["fill", "state", "start"])
    def test_name_the_provider(
        self, toy_variant: Variant, monkeypatch: pytest.MonkeyPatch, method: str
    ) -> None:
        def failing(*_: object) -> Any:
            raise ZeroDivisionError("a bug")

        config = toy_variant("one with a role for each")
        monkeypatch.setattr(Random, method, failing)
        with pytest.raises(ComponentError, match="ZeroDivisionError: a bug") as caught:
            list(assemble(config))
        assert caught.value.component == "roles.r.provider"
        assert caught.value.concerns == ("a 1" if method == "fill" else "")

    @pytest.mark.parametrize(("returned", "problem"), [(Design(), "role 'r'"), (None, "AttributeError")])
    def test_a_role_that_is_not_provided_is_named(
        self, toy_variant: Variant, monkeypatch: pytest.MonkeyPatch, returned: Any, problem: str
    ) -> None:
        monkeypatch.setattr(Random, "fill", lambda *_: returned)
        with pytest.raises(ComponentError, match=problem) as caught:
            list(assemble(toy_variant("one with a role for each")))
        assert (caught.value.component, caught.value.concerns) == ("roles.r.provider", "a 1")

    def test_a_provider_that_the_simulator_does_not_suit_is_a_fault_of_the_configuration(
        self, toy_variant: Variant, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        def refusing(*_: object) -> Any:
            raise ConfigurationError("Product draws nothing")

        monkeypatch.setattr(Random, "start", refusing)
        with pytest.raises(ConfigurationError, match="Product draws nothing") as caught:
            assemble(toy_variant("one with a role for each"))
        assert caught.value.key == "roles.r.provider"

    def test_a_file_that_cannot_be_read_is_named(
        self, toy_variant: Variant, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        def refusing(*_: object) -> Any:
            raise InputError("cannot be read", source="body.npz")

        monkeypatch.setattr(Random, "start", refusing)
        with pytest.raises(InputError, match="cannot be read") as caught:
            assemble(toy_variant("one with a role for each"))
        assert caught.value.source == "body.npz"


class TestState:
    def test_is_that_of_each_provider(self) -> None:
        roles = Roles((role("run", Constant(value=5.0)), role("run", Constant("s", 6.0), "s")))
        assert roles.state() == {"r": 5.0, "s": 6.0}
        roles.restore({"r": 5.0, "s": 6.0})

    def test_is_missing_without_roles(self) -> None:
        assert Roles().state() is None

    def test_that_differs_is_refused_by_the_provider(self) -> None:
        with pytest.raises(ComponentError, match=r"was 4\.0, and is 5\.0") as caught:
            Roles((role("run", Constant(value=5.0)),)).restore({"r": 4.0})
        assert caught.value.component == "roles.r.provider"


def test_a_design_before_all_populations_is_empty_without_roles() -> None:
    roles = Roles()
    assert dict(roles.before("a 1").roles) == {}
    complete = Design({"a": np.ones(1)})
    assert roles.after(complete, "a 1") is complete

"""Contract tests of all strategies, with their defaults and with other options."""

from typing import Any, get_args, get_type_hints

import attrs
import pytest
from collaborators import parts

from evoframe import ConfigurationError, Source, load_config
from evoframe.testing import CollaborationStrategyContract
from evoframe_strategies import (
    All,
    BestAndRandom,
    BestAndWorst,
    Fittest,
    HallOfFame,
    Informative,
    Neighbourhood,
    Previous,
    Random,
    Rank,
    Roulette,
    Scheduled,
    Shuffled,
    SpeciesChampions,
    Sum,
    Tournament,
    Worst,
    evoframe_strategies,
)
from evoframe_strategies.nesting import built_in

STRATEGIES = evoframe_strategies()


def scheduled(component: Any, n: tuple[int, ...], since: tuple[int, ...]) -> Scheduled:
    [strategy] = parts(component)
    return Scheduled(strategy, n=n, since=since)


class TestFittest(CollaborationStrategyContract):
    component = Fittest()


class TestTenFittest(CollaborationStrategyContract):
    component = Fittest(n=10)


class TestWorst(CollaborationStrategyContract):
    component = Worst(n=3)


class TestBestAndWorst(CollaborationStrategyContract):
    component = BestAndWorst()


class TestFiveBestAndFiveWorst(CollaborationStrategyContract):
    component = BestAndWorst(n=5)


class TestAll(CollaborationStrategyContract):
    component = All()


class TestSpeciesChampions(CollaborationStrategyContract):
    component = SpeciesChampions()


class TestMoreThanThereAreSpecies(CollaborationStrategyContract):
    component = SpeciesChampions(n=6)


class TestRandom(CollaborationStrategyContract):
    component = Random()


class TestFiveAtRandom(CollaborationStrategyContract):
    component = Random(n=5)


class TestBestAndRandom(CollaborationStrategyContract):
    component = BestAndRandom()


class TestBestAndFourAtRandom(CollaborationStrategyContract):
    component = BestAndRandom(n=5)


class TestTournament(CollaborationStrategyContract):
    component = Tournament()


class TestTournamentOfEverybody(CollaborationStrategyContract):
    component = Tournament(n=4, tournament_size=16)


class TestRoulette(CollaborationStrategyContract):
    component = Roulette()


class TestRouletteOfFive(CollaborationStrategyContract):
    component = Roulette(n=5)


class TestRank(CollaborationStrategyContract):
    component = Rank()


class TestRankWithFullPressure(CollaborationStrategyContract):
    component = Rank(n=5, pressure=2.0)


class TestShuffled(CollaborationStrategyContract):
    component = Shuffled()


class TestShuffledFive(CollaborationStrategyContract):
    component = Shuffled(n=5)


class TestNeighbourhood(CollaborationStrategyContract):
    component = Neighbourhood()


class TestFiveOnATorus(CollaborationStrategyContract):
    component = Neighbourhood(n=5, shape="torus")


class TestPrevious(CollaborationStrategyContract):
    component = Previous()


class TestFivePrevious(CollaborationStrategyContract):
    component = Previous(n=5)


class TestHallOfFame(CollaborationStrategyContract):
    component = HallOfFame()


class TestASmallHallOfFame(CollaborationStrategyContract):
    component = HallOfFame(n=5, capacity=3)


class TestInformative(CollaborationStrategyContract):
    component = Informative()


class TestFiveInformative(CollaborationStrategyContract):
    component = Informative(n=5)


class TestScheduled(CollaborationStrategyContract):
    component = Scheduled()


class TestAScheduleWithAMemory(CollaborationStrategyContract):
    component = scheduled(HallOfFame(), n=(4, 1, 3), since=(0, 1, 4))


class TestAScheduleForEachIndividual(CollaborationStrategyContract):
    component = scheduled(Shuffled(), n=(1, 3), since=(0, 2))


class TestSum(CollaborationStrategyContract):
    component = Sum()


class TestASumOfArchives(CollaborationStrategyContract):
    component = Sum(parts(HallOfFame(n=2), Previous(n=2), Informative(n=3), HallOfFame(n=1)))


class TestASumForEachIndividual(CollaborationStrategyContract):
    component = Sum(parts(Neighbourhood(n=2), Shuffled(n=2), Random(n=1)))


class TestASumOfEverybody(CollaborationStrategyContract):
    component = Sum(parts(HallOfFame(n=1), All()))


class TestASumOfCombinations(CollaborationStrategyContract):
    component = Sum(parts(scheduled(Previous(), n=(1, 2), since=(0, 3)), Sum()))


def contracts() -> list[type[CollaborationStrategyContract]]:
    return [
        value
        for value in globals().values()
        if isinstance(value, type) and issubclass(value, CollaborationStrategyContract)
    ]


@pytest.mark.parametrize("class_", STRATEGIES.values(), ids=list(STRATEGIES))
def test_every_strategy_has_a_contract_test(class_: type[Any]) -> None:
    tested = [contract.component for contract in contracts() if "component" in vars(contract)]
    assert any(type(component) is class_ for component in tested)


def test_the_names_are_those_of_the_configuration() -> None:
    assert dict(STRATEGIES) == {
        "all": All,
        "best-and-random": BestAndRandom,
        "best-and-worst": BestAndWorst,
        "fittest": Fittest,
        "hall-of-fame": HallOfFame,
        "informative": Informative,
        "neighbourhood": Neighbourhood,
        "previous": Previous,
        "random": Random,
        "rank": Rank,
        "roulette": Roulette,
        "scheduled": Scheduled,
        "shuffled": Shuffled,
        "species-champions": SpeciesChampions,
        "sum": Sum,
        "tournament": Tournament,
        "worst": Worst,
    }


@pytest.mark.parametrize("name", STRATEGIES)
def test_every_strategy_is_configured_by_its_name(name: str) -> None:
    config = load_config("paper", overrides=[f"collaboration={name}", "aggregator=am"])
    assert config.collaboration.component == STRATEGIES[name]()
    assert {chosen.source.entry_point for _, chosen in config.collaboration.nested("collaboration")} == {
        "strategies"
    }


WITH_N = [class_ for class_ in STRATEGIES.values() if get_type_hints(class_).get("n") is int]


@pytest.mark.parametrize("class_", [class_ for class_ in WITH_N if class_ is not BestAndWorst])
def test_any_n_that_the_population_allows_is_possible(class_: type[Any]) -> None:
    assert [class_(n=n).size(25) for n in range(1, 26)] == list(range(1, 26))
    with pytest.raises(ConfigurationError, match=r"26 collaborators .* 25 members"):
        class_(n=26).size(25)


@pytest.mark.parametrize("class_", WITH_N)
@pytest.mark.parametrize("n", [0, -1])
def test_n_is_at_least_one(class_: type[Any], n: int) -> None:
    with pytest.raises(ValueError, match=f"'n' must be >= 1: {n}"):
        class_(n=n)


@pytest.mark.parametrize("class_", STRATEGIES.values(), ids=list(STRATEGIES))
def test_an_empty_population_is_refused(class_: type[Any]) -> None:
    with pytest.raises(ConfigurationError, match=r"\b0 "):
        class_().size(0)


@pytest.mark.parametrize("class_", STRATEGIES.values(), ids=list(STRATEGIES))
def test_every_option_is_explained(class_: type[Any]) -> None:
    assert all(f"{field.name}: " in str(class_.__doc__) for field in attrs.fields(class_))


def test_defaults_of_nested_strategies_are_those_that_a_configuration_chooses() -> None:
    written = ['collaboration={name="sum", parts=["random"]}', "aggregator=am"]
    [part] = load_config("paper", overrides=written).collaboration.component.parts  # type: ignore[attr-defined]
    assert part == built_in("random", Random())
    assert isinstance(part.source, Source)
    assert get_args(get_type_hints(Sum)["parts"])

# ruff: noqa: S311 - Python's global generator is under test
import copy
import json
import os
import pickle
import random
import sys
from typing import Any

import neat
import numpy as np
import pytest
from processes import python

from evoframe import StructureError
from evoframe.testing import EvolverContract
from evoframe_evolvers import Neat
from evoframe_evolvers.cppn.documents import dump_genome
from evoframe_evolvers.cppn.genomes import GenePool
from evoframe_evolvers.neat_evolver import _selection


class TestContract(EvolverContract):
    component = Neat()


class TestContractOfCrowdedSpecies(EvolverContract):
    component = Neat(compatibility_threshold=1.0, max_stagnation=2, species_elitism=0)
    turns = 9


def start(seed: int = 0, size: int = 25, **options: Any) -> Any:
    return Neat(**options).start(3, 2, size, np.random.default_rng(seed))


def fitness_of(genomes: list[Any]) -> list[float]:
    """Return a fitness that rewards structure and depends only on the genomes."""
    return [
        sum(gene.weight for gene in genome.connections.values()) + len(genome.nodes) for genome in genomes
    ]


def turn(run: Any) -> list[Any]:
    genomes = run.ask()
    run.tell(np.array(fitness_of(genomes)), {})
    return [run.dump(genome) for genome in genomes]


def test_initial_genomes_are_those_of_the_paper() -> None:
    run = start()
    activations = set()
    for genome in map(run.dump, run.ask()):
        assert [node["id"] for node in genome["nodes"]] == [0, 1]
        links = [(link["from"], link["to"], link["enabled"]) for link in genome["connections"]]
        assert links == [(i, o, True) for i in (-1, -2, -3) for o in (0, 1)]
        assert {node["response"] for node in genome["nodes"]} == {1.0}
        assert {node["aggregation"] for node in genome["nodes"]} == {"sum"}
        activations |= {node["activation"] for node in genome["nodes"]}
    assert len(activations) > 12


def test_responses_stay_1_and_numbers_within_bounds() -> None:
    run = start(weight=Neat().weight, node_add=0.9)
    for _ in range(30):
        for genome in turn(run):
            assert {node["response"] for node in genome["nodes"]} == {1.0}
            assert all(abs(link["weight"]) <= 30 for link in genome["connections"])
            assert all(abs(node["bias"]) <= 30 for node in genome["nodes"])


def neat_alone(seed: int, generations: int) -> list[Any]:
    """Return the populations of neat-python's own loop with the same random numbers."""
    options = Neat()
    pool = GenePool(options, _selection(options), 3, 2, np.random.default_rng(seed))
    config = pool.config
    config.pop_size = 25
    config.genome_config.node_indexer = None  # as neat-python would choose it
    history = []

    def evaluate(genomes: list[Any], _: Any) -> None:
        history.append([dump_genome(genome) for _, genome in genomes])
        for (_, genome), fitness in zip(genomes, fitness_of([g for _, g in genomes]), strict=True):
            genome.fitness = fitness

    with pool.stream.swapped_in():
        neat.Population(config).run(evaluate, generations)
    return history


@pytest.mark.parametrize("seed", range(3))
def test_it_evolves_as_neat_pythons_own_loop(seed: int) -> None:
    run = start(seed)
    assert [turn(run) for _ in range(40)] == neat_alone(seed, 40)


def test_asking_twice_is_refused() -> None:
    run = start()
    run.ask()
    with pytest.raises(RuntimeError, match=r"^ask\(\) .*tell\(\)"):
        run.ask()


def test_telling_without_asking_is_refused() -> None:
    run = start(size=3)
    with pytest.raises(RuntimeError, match=r"^tell\(\) .*ask\(\)"):
        run.tell(np.zeros(3), {})
    run.ask()
    run.tell(np.zeros(3), {})
    with pytest.raises(RuntimeError, match=r"^tell\(\) .*ask\(\)"):
        run.tell(np.zeros(3), {})


@pytest.mark.parametrize(
    ("fitness", "message"),
    [
        ([1.0, 2.0], r"\(3,\), found \(2,\)"),
        ([[1.0, 2.0, 3.0]], r"\(3,\), found \(1, 3\)"),
        ([1.0, float("nan"), 2.0], "finite .* nan"),
        ([1.0, float("-inf"), 2.0], "finite .* -inf"),
    ],
)
def test_bad_fitness_is_refused_and_changes_nothing(fitness: Any, message: str) -> None:
    run = start(size=3)
    run.ask()
    before = run.state()
    with pytest.raises(ValueError, match=message):
        run.tell(np.array(fitness), {})
    assert run.state() == before


def test_members_have_the_properties_of_their_genomes() -> None:
    run = start(node_add=0.9)
    for _ in range(12):
        told = turn(run)
    fitness = {member.id: member.fitness for member in run.members()}
    born = {genome["id"] for genome in told}
    genomes = run.ask()
    assert list(genomes) == list(run.genomes())
    for member, genome in zip(run.members(), genomes, strict=True):
        enabled = sum(link["enabled"] for link in run.dump(genome)["connections"])
        assert member.id == genome.key
        assert member.genome_size == len(genome.nodes) + enabled
        assert member.fitness == fitness.get(member.id)
        assert (member.age > 0) == (member.id in born)
        assert genome.key in run._species_set.species[member.species].members
    assert len({member.age for member in run.members()}) > 1


def test_age_counts_the_turns_of_an_elite() -> None:
    run = start()
    for age in range(6):
        genomes = run.ask()
        oldest = run.members()[[genome.key for genome in genomes].index(1)]
        assert oldest.age == age
        run.tell(np.array([1.0 if genome.key == 1 else 0.0 for genome in genomes]), {})


def test_extreme_fitness_does_not_overflow() -> None:
    run = start(size=6)
    for sign in (1, -1) * 10:
        run.ask()
        fitness = sign * np.array([1.7e308, -1.7e308, 5e-324, 0.0, -0.0, 1e300])
        run.tell(fitness, {})
        assert [member.fitness for member in run.members()] == fitness.tolist()


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"compatibility_threshold": 1.0, "node_add": 0.8},
        {"max_stagnation": 2, "species_elitism": 0},
        {"compatibility_threshold": 0.0, "size": 7},
        {"species_fitness": "median", "survival_threshold": 0.1},
    ],
)
def test_a_run_saved_after_every_turn_is_the_uninterrupted_one(options: dict[str, Any]) -> None:
    uninterrupted, saved = start(**options), start(**options)
    for number in range(40):
        state = saved.state()
        text = json.dumps(state, allow_nan=False)
        assert json.loads(text) == state
        saved = start(seed=number + 1, **options)
        saved.restore(json.loads(text))
        assert saved.state() == state
        assert turn(saved) == turn(uninterrupted)
        assert saved.members() == uninterrupted.members()


def test_a_run_saved_between_ask_and_tell_is_the_uninterrupted_one() -> None:
    uninterrupted, saved = start(), start()
    for _ in range(10):
        expected = uninterrupted.ask()
        asked = saved.ask()
        state = json.loads(json.dumps(saved.state()))
        saved = start(seed=99)
        saved.restore(state)
        assert [saved.dump(g) for g in saved.genomes()] == [saved.dump(g) for g in asked]
        saved.tell(np.array(fitness_of(saved.genomes())), {})
        uninterrupted.tell(np.array(fitness_of(expected)), {})
    assert saved.state() == uninterrupted.state()


SCRIPT = """
import hashlib, json
import numpy as np
from evoframe_evolvers import Neat, RandomSearch
for evolver in (Neat(node_add=0.8), RandomSearch(mutations=9)):
    run = evolver.start(4, 1, 25, np.random.default_rng(3))
    for turn in range(25):
        genomes = run.ask()
        outputs = [run.express(g)(np.arange(32.0).reshape(8, 4)).sum() for g in genomes]
        run.tell(np.arctan(outputs), {})
    print(hashlib.sha256(json.dumps(run.state()).encode()).hexdigest())
"""


def test_the_hash_seed_of_python_does_not_matter() -> None:
    def outcome(hash_seed: str) -> str:
        done = python("-c", SCRIPT, PYTHONHASHSEED=hash_seed, PYTHONPATH=os.pathsep.join(sys.path))
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert outcome("0") == outcome("1") == outcome("31337")


def test_interleaved_populations_equal_each_alone_and_do_not_change_the_global_random_state() -> None:
    alone = {seed: [turn(run) for run in [start(seed)] for _ in range(15)] for seed in (1, 2)}
    random.seed(7)
    expected = [random.random() for _ in range(30)]
    random.seed(7)
    runs, drawn = {1: start(1), 2: start(2)}, []
    histories: dict[int, list[Any]] = {1: [], 2: []}
    for _ in range(15):
        for seed, run in runs.items():
            histories[seed].append(turn(run))
            drawn.append(random.random())
    assert histories == alone
    assert drawn == expected


def test_the_generator_is_drawn_from_once_at_the_start() -> None:
    rng, drawn = np.random.default_rng(0), np.random.default_rng(0)
    run = Neat().start(3, 2, 25, rng)
    drawn.bytes(32)
    assert rng.bit_generator.state == drawn.bit_generator.state
    turn(run)
    turn(run)
    assert rng.bit_generator.state == drawn.bit_generator.state


@pytest.mark.parametrize("duplicate", [copy.copy, copy.deepcopy, pickle.dumps])
def test_a_population_cannot_be_copied(duplicate: Any) -> None:
    run = start(size=3)
    with pytest.raises(TypeError, match=r"state\(\) and restore\(\)"):
        duplicate(run._pool)


def test_memory_does_not_grow() -> None:
    run = start()
    for _ in range(30):
        turn(run)
    assert not run._reproduction.ancestors
    assert len(run._cohort.born) == len(run._cohort.fitness) == 25


def delete(*path: Any) -> Any:
    return lambda state: _walk(state, path[:-1]).pop(path[-1])


def put(value: Any, *path: Any) -> Any:
    def change(state: Any) -> None:
        _walk(state, path[:-1])[path[-1]] = value

    return change


def _walk(state: Any, path: tuple[Any, ...]) -> Any:
    for part in path:
        state = state[part]
    return state


MEMBER = ("cohort", "members", 0)
NODE = (*MEMBER, "genome", "nodes", 0)
LINK = (*MEMBER, "genome", "connections", 0)

DAMAGE = [
    *[delete(key) for key in ("evolver", "pool", "cohort", "species", "next_species")],
    *[delete("pool", key) for key in ("next_genome", "next_node", "innovation", "innovations", "random")],
    *[delete("cohort", key) for key in ("generation", "phase", "members")],
    *[delete(*MEMBER, key) for key in ("born", "fitness", "genome")],
    *[delete(*NODE, key) for key in ("id", "bias", "response", "activation", "aggregation", "time_constant")],
    *[delete(*LINK, key) for key in ("from", "to", "innovation", "weight", "enabled")],
    *[
        delete("species", 0, key)
        for key in (
            "id",
            "created",
            "last_improved",
            "representative",
            "members",
            "fitness",
            "adjusted_fitness",
            "best_fitness",
        )
    ],
    delete("cohort", "members", 0),
    delete("species", 0, "members", 0),
    put("random", "evolver"),
    put(1, "pool", "next_genome"),
    put(0, "pool", "next_node"),
    put(1.5, "pool", "innovation"),
    put([[1, 2]], "pool", "innovations"),
    put([[1, 2, 3, 4]], "pool", "innovations"),
    put([[[], 2, "add", 4]], "pool", "innovations"),
    put([3, [], None], "pool", "random"),
    put("lost", "cohort", "phase"),
    put(-1, "cohort", "generation"),
    put(1000, *MEMBER, "born"),
    put(float("nan"), *MEMBER, "fitness"),
    put(None, *MEMBER, "fitness"),
    put(10**6, *MEMBER, "genome", "id"),
    put(None, *MEMBER, "genome", "id"),
    put("sine", *NODE, "activation"),
    put("max", *NODE, "aggregation"),
    put(float("inf"), *NODE, "bias"),
    put("1", *NODE, "bias"),
    put(1, *NODE, "id"),
    put(77, *LINK, "to"),
    put(1, *LINK, "enabled"),
    put(0, "species", 0, "id"),
    put(10**6, "species", 0, "id"),
    put(10**6, "species", 0, "representative"),
    put([], "species"),
    put([None], "species"),
    put("x", "species", 0, "best_fitness"),
    put(None, "species", 0, "members"),
    put([[]], "species", 0, "members"),
]


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_state_is_refused_and_changes_nothing(damage: Any) -> None:
    run, other = start(), start(seed=1)
    for _ in range(3):
        turn(run)
        turn(other)
    damaged = run.state()
    damage(damaged)
    before = other.state()
    with pytest.raises(ValueError, match=r"."):
        other.restore(damaged)
    assert other.state() == before


@pytest.mark.parametrize("state", [None, 3, "x", []])
def test_a_state_must_be_a_table(state: Any) -> None:
    with pytest.raises(StructureError, match=r"^state: ") as caught:
        start().restore(state)
    [fault] = caught.value.faults
    assert fault.path == ("state",)


def test_every_key_of_a_state_must_be_there_and_no_other() -> None:
    state = start().state()
    keys = list(state)
    for key in keys:
        with pytest.raises(StructureError) as caught:
            start().restore({other: state[other] for other in keys if other != key})
        assert [fault.path for fault in caught.value.faults] == [("state", key)]
    with pytest.raises(StructureError) as caught:
        start().restore(state | {"color": 1})
    assert [fault.path for fault in caught.value.faults] == [("state", "color")]


def test_all_faults_of_a_state_are_named_with_their_places() -> None:
    state = start().state()
    put("lost", "cohort", "phase")(state)
    put(0, "species", 0, "id")(state)
    put(1.5, "pool", "innovation")(state)
    with pytest.raises(StructureError) as caught:
        start().restore(state)
    faults = {".".join(fault.path): fault.message for fault in caught.value.faults}
    assert [*faults] == ["state.pool.innovation", "state.cohort.phase", "state.species[0].id"]
    assert "found 1.5" in faults["state.pool.innovation"]
    assert '"new", "asked", "told", found "lost"' in faults["state.cohort.phase"]
    assert ">= 1, found 0" in faults["state.species[0].id"]


def test_a_fault_of_a_genome_is_named_with_its_place() -> None:
    state = start().state()
    put("1", *LINK, "weight")(state)
    place = r"^state\.cohort\.members\[0\]\.genome\.connections\[0\]\.weight: "
    with pytest.raises(StructureError, match=place):
        start().restore(state)


def test_ids_in_use_are_not_assigned_again() -> None:
    for key in ("next_genome", "next_node"):
        state = start().state()
        state["pool"][key] -= 1
        with pytest.raises(ValueError, match=rf"^state\.pool\.{key}: .*> {state['pool'][key]}, "):
            start().restore(state)


@pytest.mark.parametrize("other", [(4, 2, 25), (3, 1, 25), (3, 3, 25), (3, 2, 24)])
def test_the_state_of_another_population_is_refused(other: tuple[int, int, int]) -> None:
    state = start().state()
    with pytest.raises(ValueError, match=r"."):
        Neat().start(*other, np.random.default_rng(0)).restore(state)


def seeded(runs: int, seed: int = 0) -> Any:
    """Return a run that starts from the last genomes of others."""
    run, genomes = start(seed), []
    for other in range(1, runs + 1):
        evolved = start(other, node_add=0.9, connection_add=0.9)
        for _ in range(5):
            dumped = turn(evolved)
        genomes += [run.load(genome) for genome in dumped[:4]]
    run.seed(genomes)
    return run, genomes


@pytest.mark.filterwarnings("error")  # neat-python warns of numbers that stand for two connections
@pytest.mark.parametrize("runs", [1, 3])
def test_a_run_that_starts_from_genomes_of_others_evolves_without_collisions(runs: int) -> None:
    run, _ = seeded(runs)
    for _ in range(30):
        numbers: dict[int, tuple[int, int]] = {}
        for genome in turn(run):
            for link in genome["connections"]:
                ends = link["from"], link["to"]
                assert numbers.setdefault(link["innovation"], ends) == ends


def test_seeds_and_their_mutants_are_put_into_species() -> None:
    run, genomes = seeded(3)
    run.ask()
    members = run.members()
    species = {member.species for member in members}
    assert species == set(range(1, len(species) + 1))
    assert [member.genome_size for member in members[: len(genomes)]] == [sum(g.size()) for g in genomes]


def test_mutants_resemble_their_seeds() -> None:
    run = start()
    big = start(1, node_add=1.0, node_delete=0.0, connection_delete=0.0)
    for _ in range(8):
        genomes = turn(big)
    large = max(genomes, key=lambda genome: len(genome["nodes"]))
    run.seed([run.load(large)])
    _, *mutants = map(run.dump, run.ask())
    n_nodes = len(large["nodes"])
    assert n_nodes > 5
    assert all(abs(len(mutant["nodes"]) - n_nodes) <= 1 for mutant in mutants)
    assert any(mutant["nodes"] != large["nodes"] for mutant in mutants)


def test_a_genome_of_other_networks_is_not_loaded() -> None:
    other = Neat().start(4, 1, 5, np.random.default_rng(0))
    [genome, *_] = map(other.dump, other.ask())
    with pytest.raises(ValueError, match="does not exist: -4"):
        start().load(genome)


def test_a_run_without_seeds_is_that_of_a_run_that_loads_genomes() -> None:
    plain, loading = start(), start()
    for _ in range(5):
        for genome in turn(start(7)):
            loading.load(genome)
        assert turn(loading) == turn(plain)

"""The laws of evolvers whose runs load genomes, and start from given ones."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import strategies as st

from evoframe.contract import EvolverRun, SupportsLoad, SupportsSeeds
from evoframe.testing.evolving import Evolving, dumped_all, json_text
from evoframe.testing.laws import JUNK, damaged_at, for_all, places_in, same_bits

__all__ = ["SeedingLaws"]


class SeedingLaws(Evolving):
    """The laws of :class:`~evoframe.SupportsLoad` and :class:`~evoframe.SupportsSeeds`, if offered."""

    def test_a_loaded_genome_is_the_dumped_one(self) -> None:
        """A genome that another run loads has the same dump and the same network, to the last bit."""
        other = self.start(seed=1)
        if not isinstance(other, SupportsLoad):
            return
        for run, genomes in self._play(self.start()):
            for genome in genomes:
                dumped = json.loads(json_text(run.dump(genome)))
                loaded = other.load(dumped)
                assert other.dump(loaded) == dumped, "dump(load(dumped)) must equal dumped"
                self._assert_same_network(other, loaded, run, genome, "load() returns another network")

    def test_loading_changes_neither_the_run_nor_the_document(self) -> None:
        """``load`` can be called at any time, with genomes of other runs, and keeps its argument."""
        run = self.start()
        if not isinstance(run, SupportsLoad):
            return
        history = []
        for text in self._texts(seed=1)[: self.turns]:
            document = json.loads(text)
            run.load(document)
            assert json_text(document) == text, "load() must not change its argument"
            history.append(self._turn(run))
        assert history == self._history(self.start(), len(history)), "load() must not change the run"

    def test_a_damaged_genome_is_not_loaded(self) -> None:
        """A damaged genome gives a ``ValueError``, or a genome whose network has finite outputs."""
        run = self.start()
        if not isinstance(run, SupportsLoad):
            return
        texts = self._texts(seed=0)[:: self.size]

        def law(text: str, junk: Any, data: st.DataObject) -> None:
            genome = json.loads(text)
            damaged = damaged_at(data.draw(st.sampled_from(list(places_in(genome)))), genome, junk)
            try:
                loaded = run.load(damaged)
            except ValueError:
                return
            outputs = run.express(loaded)(self._points(0, 1.0))
            assert np.isfinite(outputs).all(), f"load() accepts {damaged}, whose network is not finite"

        for_all(law, text=st.sampled_from(texts), junk=JUNK, data=st.data())

    def test_the_initial_population_begins_with_the_seeds(self) -> None:
        """The first networks are those of the seeds, to the last bit; the population keeps its size."""
        for count in sorted({1, 1 + self.size // 2, self.size}) if self._offers_seeds() else ():
            run, seeds = self._seeded(self._texts(seed=1)[-count:])
            genomes = run.ask()
            assert len(genomes) == self.size, f"expected {self.size} genomes, found {len(genomes)}"
            for seed, genome in zip(seeds, genomes, strict=False):
                self._assert_same_network(
                    run, seed, run, genome, "the initial population must begin with the seeds, in their order"
                )

    def test_mutants_of_the_seeds_fill_the_initial_population(self) -> None:
        """If one seed is given, some of the other networks differ from its network."""
        if self._offers_seeds() and self.size > 1:
            run, [seed] = self._seeded(self._texts(seed=1)[-1:])
            points = self._points(0, 1.0)
            expected = run.express(seed)(points)
            others = [run.express(genome)(points) for genome in run.ask()[1:]]
            assert not all(same_bits(outputs, expected) for outputs in others), (
                "mutants of the seeds must fill the initial population, found only copies"
            )

    def test_ids_of_a_seeded_run_stand_for_one_genome(self) -> None:
        """Ids are unique, even if seeds are equal, or come from different runs with the same ids."""
        if not self._offers_seeds():
            return
        known: dict[int, str] = {}
        run, _ = self._seeded(self._repeating_texts())
        for playing, genomes in self._play(run):
            ids = [member.id for member in playing.members()]
            assert len(set(ids)) == len(ids) == self.size, (
                f"members of a seeded run must have different ids, found {ids}"
            )
            for id_, text in zip(ids, dumped_all(playing, genomes), strict=True):
                assert known.setdefault(id_, text) == text, f"the id {id_} belongs to two different genomes"

    def test_initial_members_of_a_seeded_run_are_new(self) -> None:
        """Seeds are evaluated like other initial members: without fitness and with age 0 before ``tell``."""
        if self._offers_seeds():
            run, _ = self._seeded(self._repeating_texts())
            run.ask()
            found = {(member.fitness, member.age) for member in run.members()}
            assert found == {(None, 0)}, f"expected members without fitness and of age 0, found {found}"

    def test_seeded_runs_with_the_same_seed_are_equal(self) -> None:
        """The same generator and the same seeds give the same evolution, to the last bit."""
        if self._offers_seeds():
            one, other = (self._seeded(self._repeating_texts())[0] for _ in "12")
            assert self._history(one) == self._history(other), (
                "two seeded runs with the same generator differ; draw from the generator of start() only"
            )

    def test_a_seeded_run_is_restored_without_its_seeds(self) -> None:
        """A run without seeds continues bit for bit from the state of a seeded one, after any turn."""
        if not self._offers_seeds():
            return
        expected = self._history(self._seeded(self._repeating_texts())[0])
        run, _ = self._seeded(self._repeating_texts())
        for turn in range(self.turns):
            self._turn(run)
            restored = self.start(seed=turn + 100)
            restored.restore(json.loads(json_text(run.state())))
            assert self._history(restored, self.turns - turn - 1) == expected[turn + 1 :], (
                f"a seeded run restored after turn {turn} continues differently; is all of it in the state?"
            )

    def test_seeds_are_not_changed(self) -> None:
        """The genomes that were given as seeds, which an archive may hold, do not change during the run."""
        if self._offers_seeds():
            texts = self._texts(seed=1)[-self.size :]
            run, seeds = self._seeded(texts)
            self._history(run)
            assert [run.dump(seed) for seed in seeds] == list(map(json.loads, texts)), (
                "seed() and the run must not change the given genomes; work on copies"
            )

    def test_a_wrong_number_of_seeds_is_refused(self) -> None:
        """``seed`` refuses no genomes, and more than members, by a ``ValueError``; the run is unchanged."""
        if not self._offers_seeds():
            return
        for texts in ([], self._texts(seed=1)[: self.size + 1]):
            run = self.start()
            assert isinstance(run, SupportsSeeds)
            with pytest.raises(ValueError, match=r"."):
                run.seed([run.load(json.loads(text)) for text in texts])
            assert self._history(run) == self._history(self.start()), (
                "a refused seed() must not change the run"
            )

    def _offers_seeds(self) -> bool:
        return isinstance(self.start(), SupportsSeeds)

    def _texts(self, seed: int) -> list[str]:
        """Return the dumped genomes of all turns of a run."""
        return [
            text for run, genomes in self._play(self.start(seed)) for text in dumped_all(run, genomes)
        ]  # fmt: skip

    def _repeating_texts(self) -> list[str]:
        """Return genomes of two runs, one of them twice."""
        one, other = self._texts(seed=1)[-1], self._texts(seed=2)[-1]
        return [one, other, one][: self.size]

    def _seeded(self, texts: Sequence[str]) -> tuple[EvolverRun, list[Any]]:
        """Return a run that starts from dumped genomes, and its seeds."""
        run = self.start()
        assert isinstance(run, SupportsSeeds)
        seeds = [run.load(json.loads(text)) for text in texts]
        run.seed(seeds)
        return run, seeds

    def _assert_same_network(
        self, run: EvolverRun, genome: Any, other: EvolverRun, other_genome: Any, problem: str
    ) -> None:
        points = self._points(0, 1.0)
        assert same_bits(run.express(genome)(points), other.express(other_genome)(points)), problem

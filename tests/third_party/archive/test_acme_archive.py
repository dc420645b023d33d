"""Contract tests of ``record-holders``, and an example."""

import numpy as np
from acme_archive import RecordHolders

from evoframe import Archived, Judged, Member, ScoredMeetings
from evoframe.testing import CollaborationStrategyContract


class TestRecordHolders(CollaborationStrategyContract):
    component = RecordHolders()


class TestASmallArchive(CollaborationStrategyContract):
    component = RecordHolders(n=4, capacity=2)


def turn(index: int, scores: list[float], ids: list[int]) -> ScoredMeetings:
    """Return a turn in which one predator met all prey."""
    prey = tuple(Member(id_, score) for id_, score in zip(ids, scores, strict=True))
    pairs = np.array([[0, place] for place in range(len(ids))], dtype=np.intp)
    members = ((Member(1, 0.0),), prey)
    return ScoredMeetings(index, ("predator", "prey"), members, (1, len(ids)), pairs, np.array(scores))


def test_individuals_of_records_return_after_they_have_left() -> None:
    run = RecordHolders(n=2).start("predator", "prey")
    for index, (scores, ids) in enumerate(
        [([1.0, 3.0], [11, 12]), ([2.0, 3.0], [13, 14]), ([4.0, np.nan], [15, 16])]
    ):
        genomes = [{"id": id_} for id_ in ids]
        run.observe(turn(index, scores, ids), genomes.__getitem__)
    judged, members = [Judged(Member(1, 0.0), index=0)], [Member(15, 4.0), Member(17, 9.0)]
    [[latest, earlier]] = run.choose(judged, members, np.random.default_rng())
    assert latest == 0  # the individual 15 is still a member
    assert isinstance(earlier, Archived)
    assert (earlier.member.id, earlier.genome) == (12, {"id": 12})  # 14 only equalled the record

"""How far runs are, and why some failed."""

from __future__ import annotations

from pathlib import Path

import pytest

from evoframe.files.locks import locked
from evoframe.record.layout import VERIFICATION_FILE
from evoframe.study.plan import Planned, Study
from evoframe.study.progress import FAILURE_FILE, Status, forget_failure, note_failure, status_of

Made = tuple[Study, Path, list[Planned]]


def test_a_failure_is_noted_until_it_is_forgotten(made: Made) -> None:
    [planned, *_] = made[2]
    note_failure(planned.directory, "a fault")
    assert (status_of(planned).state, status_of(planned).cause) == ("failed", "a fault")
    forget_failure(planned.directory)
    assert status_of(planned).state == "finished"
    forget_failure(planned.directory)  # by another process, meanwhile


def test_the_first_cause_stays(made: Made) -> None:
    [planned, *_] = made[2]
    note_failure(planned.directory, "a fault")
    note_failure(planned.directory, "its consequence")
    assert status_of(planned).cause == "a fault"


def test_no_failure_is_noted_of_a_run_at_which_another_process_is(made: Made) -> None:
    [planned, *_] = made[2]
    with locked(planned.directory):
        note_failure(planned.directory, "a fault")
    assert status_of(planned).state == "finished"


def test_a_finished_run_is_complete_when_it_is_verified_or_cannot_be(made: Made) -> None:
    never, varied, *_ = made[2]
    assert not (never.directory / VERIFICATION_FILE).exists()
    assert status_of(never) == status_of(varied) == Status("finished")
    (varied.directory / VERIFICATION_FILE).unlink()
    assert status_of(varied) == Status("finished", verified=False)
    assert status_of(varied).is_done
    assert not status_of(varied).is_complete


@pytest.mark.parametrize("text", ["", "[]", "{}"])
def test_a_failure_that_says_no_cause_is_one(made: Made, text: str) -> None:
    [planned, *_] = made[2]
    (planned.directory / FAILURE_FILE).write_text(text)
    assert (status_of(planned).state, status_of(planned).cause) == ("failed", "unknown")

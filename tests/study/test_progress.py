"""Statuses of runs, and the causes of failures."""

from __future__ import annotations

from pathlib import Path

import pytest

from evoframe.files.locks import locked
from evoframe.record.layout import VERIFICATION_FILE
from evoframe.study.plan import Planned, Study
from evoframe.study.progress import FAILURE_FILE, Status, clear_failure, record_failure, status_of

Made = tuple[Study, Path, list[Planned]]


def test_a_failure_is_recorded_until_it_is_cleared(made: Made) -> None:
    [planned, *_] = made[2]
    record_failure(planned.directory, "a fault")
    assert (status_of(planned).state, status_of(planned).cause) == ("failed", "a fault")
    clear_failure(planned.directory)
    assert status_of(planned).state == "finished"
    clear_failure(planned.directory)  # after another process has cleared it


def test_the_first_cause_stays(made: Made) -> None:
    [planned, *_] = made[2]
    record_failure(planned.directory, "a fault")
    record_failure(planned.directory, "its consequence")
    assert status_of(planned).cause == "a fault"


def test_no_failure_is_recorded_for_a_run_that_another_process_executes(made: Made) -> None:
    [planned, *_] = made[2]
    with locked(planned.directory):
        record_failure(planned.directory, "a fault")
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
def test_a_failure_without_a_cause_counts(made: Made, text: str) -> None:
    [planned, *_] = made[2]
    (planned.directory / FAILURE_FILE).write_text(text)
    assert (status_of(planned).state, status_of(planned).cause) == ("failed", "unknown")


def test_a_cause_that_names_a_file_of_any_bytes_is_kept(made: Made) -> None:
    [planned, *_] = made[2]
    record_failure(planned.directory, "no file b\udcff")
    assert status_of(planned).cause == "no file b?"

"""The names of the built-in executors."""

from evoframe_executors import Processes, Serial, Threads, evoframe_executors


def test_the_names_are_those_of_the_configuration() -> None:
    assert dict(evoframe_executors()) == {
        "processes": Processes,
        "serial": Serial,
        "threads": Threads,
    }

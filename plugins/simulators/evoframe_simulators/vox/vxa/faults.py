"""Faults of a file, collected for one error in the words of the file."""

from __future__ import annotations

from collections.abc import Iterator

import attrs

from evoframe import InputError

__all__ = ["Faults"]

_MOST_SHOWN = 10

_UNSUPPORTED = "not simulated by vox; change or remove"
_OUT_OF_RANGE = "out of range"
_MISSING = "missing"


@attrs.frozen
class Faults:
    """Faults of a file by kind; each is reported with the path of its tag."""

    _found: dict[str, list[tuple[str, str]]] = attrs.field(factory=dict)

    def unsupported(self, place: str, value: str, why: str = "") -> None:
        """Add the path and value of a tag that vox does not simulate, and a reason if it is not obvious."""
        self._add(_UNSUPPORTED, place, f"= {value}" + (f" ({why})" if why else ""))

    def out_of_range(self, place: str, problem: str) -> None:
        """Add the path of a tag whose value vox does not accept."""
        self._add(_OUT_OF_RANGE, place, problem)

    def missing(self, place: str, problem: str) -> None:
        """Add the path of a tag without which the file cannot be simulated."""
        self._add(_MISSING, place, problem)

    def within(self, place: str) -> bool:
        """Return whether there is a fault inside a section, given by its path."""
        return any(at.startswith(f"{place}/") for some in self._found.values() for at, _ in some)

    def __bool__(self) -> bool:
        """Whether there are faults."""
        return bool(self._found)

    def check(self) -> None:
        """Reject the file if there are faults.

        Raises:
            InputError: The faults by kind, each in its own line, at most ten of them; a single fault is one
                line, and its tag is the key.
        """
        faults = [(kind, *fault) for kind, some in self._found.items() for fault in some]
        if len(faults) == 1:
            [(kind, place, problem)] = faults
            raise InputError(f"{kind}: {problem.removeprefix('= ')}", key=place)
        if faults:
            more = len(faults) - _MOST_SHOWN
            lines = [f"{len(faults)} faults", *_grouped(faults[:_MOST_SHOWN])]
            raise InputError("\n  ".join([*lines, *([f"... and {more} more"] if more > 0 else [])]))

    def _add(self, kind: str, place: str, problem: str) -> None:
        self._found.setdefault(kind, []).append((place, problem))


def _grouped(faults: list[tuple[str, str, str]]) -> Iterator[str]:
    """Yield a line for each kind, followed by a line for each of its faults."""
    before = ""
    for kind, place, problem in faults:
        if kind != before:
            yield f"{kind}:"
        before = kind
        yield f"  {place}{' ' if problem.startswith('= ') else ': '}{problem}"

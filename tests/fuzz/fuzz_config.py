"""Fuzz target of atheris for the reader of configurations: see docs/fuzzing.md.

An input is the text of a TOML file, followed by the value of a ``--set`` after each byte 0. The reader must
refuse it with a ``ConfigurationError``, or return a configuration that is equal after writing and reading it.
"""

from __future__ import annotations

import functools
import os
import random
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

import atheris

with atheris.instrument_imports(include=["evoframe", "evoframe_simulators", "evoframe_strategies"]):
    import evoframe

PLUGINS = evoframe.discover()
VALUES = (
    *("0", "1", "-1", "2", "3", "25", "1e3", "-0.0", "0.5", "1e308", "5e-324", "inf", "-inf", "nan"),
    *("9223372036854775808", "-9223372036854775809", "1" + "0" * 400, "0x7f", "1_000", "true", "false"),
    *('"fuzzed.toml"', '"again.toml"', '"\\u0000.toml"', '"."', '"random"', '"fittest"', '"evoframe>=1"'),
    *('""', '"vox"', '"neat"', '"paper"', '"cycles"', '"\\u0000"', '"\\U0001F600"', "'a'", '"""\n"""'),
    *("[]", "[[]]", "[1, 2]", "[20, 8, 8]", "[0.7, 0.3]", '["x"]', "[{}]"),
    *("{}", '{name = "vox"}', "{a.b = 1}", "[" * 200 + "]" * 200, "[" * 3000),
    *("1979-05-27", "07:32:00", "1979-05-27T07:32:00Z"),
)
"""Values of each kind of TOML value, including edge cases."""


WORDS = (
    *("morphology", "controller", "third", "turn", "score", "Role", "encoder", "evolver"),
    *("name", "extends", "x.y", ".".join("z" * 600)),
)
"""Replacements for keys and names of populations."""


def load_unless_refused(source: Path, overrides: list[str]) -> evoframe.RunConfig | None:
    try:
        return evoframe.load_config(source, overrides=overrides, plugins=PLUGINS)
    except evoframe.ConfigurationError as error:
        if not str(error).strip():
            raise RuntimeError("an error without text") from error
        return None


def test_one_input(data: bytes) -> None:
    text, *overrides = data.split(b"\0")
    path = Path("fuzzed.toml")
    path.write_bytes(text)
    config = load_unless_refused(path, [os.fsdecode(override) for override in overrides])
    if config is None:
        return
    again = Path("again.toml")
    again.write_text(config.to_toml(), encoding="utf-8")
    if evoframe.load_config(again, plugins=PLUGINS).tables() != config.tables():
        raise RuntimeError("the configuration differs after writing and reading it")


@functools.cache
def known_keys() -> list[tuple[str, ...]]:
    """Return the path of every key of the preset ``paper``."""

    def below(tree: dict[str, Any], path: tuple[str, ...]) -> list[tuple[str, ...]]:
        found = []
        for key, value in tree.items():
            found.append((*path, key))
            if isinstance(value, dict):
                found += below(value, (*path, key))
        return found

    return [*below(evoframe.load_config("paper", plugins=PLUGINS).tables(), ()), ("extends",)]


def mutated(data: bytes, max_size: int, seed: int) -> bytes:
    """Return *data* with a known key and any value inserted, or mutated by libFuzzer."""
    draw = random.Random(seed)  # noqa: S311 - no secret depends on it
    if draw.random() < 0.5:
        return atheris.Mutate(data, max_size)
    keys = list(draw.choice(known_keys()))
    if draw.random() < 0.2:
        keys[draw.randrange(len(keys))] = draw.choice(WORDS)
    *tables, key = keys
    value = draw.choice(VALUES)
    if draw.random() < 0.3:
        return (data + f"\0{'.'.join([*tables, key])}={value}".encode())[:max_size]
    text, *overrides = data.split(b"\0")
    lines = text.split(b"\n")
    at = draw.randrange(len(lines) + 1)
    header = [f"[{'.'.join(tables)}]".encode()] if tables and draw.random() < 0.7 else []
    lines[at : at + draw.randrange(3)] = [*header, f"{key} = {value}".encode()]
    return b"\0".join([b"\n".join(lines), *overrides])[:max_size]


def main() -> None:
    script, *given = [part if part.startswith("-") else str(Path(part).resolve()) for part in sys.argv]
    program = f"{sys.executable} {script}"  # libFuzzer restarts it to merge
    atheris.Setup([program, *given], test_one_input, custom_mutator=mutated)
    warnings.simplefilter("error")  # no file may cause a warning
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        atheris.Fuzz()


if __name__ == "__main__":
    main()

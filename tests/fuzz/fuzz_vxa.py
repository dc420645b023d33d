"""Fuzz target of atheris for the reader of VXA files: see docs/fuzzing.md.

The reader must refuse a file with an ``InputError`` or a ``ConfigurationError``, or return a body that can be
simulated, and exported to a file with the same body and settings.
"""

from __future__ import annotations

import os
import random
import re
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import atheris
import numpy as np

with atheris.instrument_imports(include=["evoframe", "evoframe_simulators"]):
    import evoframe
    from evoframe_simulators import Vox
    from evoframe_simulators.vox.vxa import document
    from evoframe_simulators.vox.vxa.schema import VXA

import attrs

PLUGINS = evoframe.discover()
MOST_CELLS, MOST_STEPS = 64, 100  # of a body that is simulated
REFUSED = (evoframe.InputError, evoframe.ConfigurationError)

TEXTS = (
    *("", " ", "0", "1", "-1", "2", "3", "4", "5", "63", "64", "257", "0.5", "1.5", "-0.0", "1e3", "5e6"),
    *("nan", "inf", "-inf", "1e308", "1e400", "1e-3", "1e-320", "9" * 30, "9" * 5000, "0x10", "1_0", "+1"),
    *("true", "FALSE", "a", "~", "\x00", "\u00e9", "\u0661", "1,5", "11", "33", "1111", "0110", ",,,"),
    *("0,0", "0,0,0,0", "0,0.25,", "nan,0,0,0", "1,3", "0 0", "&amp;", "&#49;", "&#0;", "&x;"),
    *("AQ==", "AQM=", "AQMDAQ==", "eJxjBAAAAgAC", "eJxjZGZmBAAAFQAJ", "AAAABHicY2RmZgQAABUACQ=="),
    *("<mtSUB><mtVAR>t</mtVAR><mtCONST>0.1</mtCONST></mtSUB>", "<mtSUB/>"),
    *("<![CDATA[1]]>", "<a/>", "<!--1-->1"),
)
"""Texts of elements: flags, counts, numbers, layers, and invalid ones."""


def names_in(schema: Mapping[str, Any]) -> Iterator[str]:
    for tag, inner in schema.items():
        yield tag
        if isinstance(inner, Mapping):
            yield from names_in(inner)


TAGS = sorted({*names_in(VXA), "VXC", "VXD", "VXA", "AfterlifeTime", "GPU"})
DIALECTS = ("", *Vox.dialects)
OVERRIDES: tuple[dict[str, Any], ...] = (
    {},
    {},
    {"duration": 0.01},
    {"time_step_fraction": 0.5, "duration": 0.01},
    {"palette": []},
    {"gravity": 0.0, "floor": False},
)
LEAF = re.compile(rb"<([A-Za-z_]+)(?: [^<>]*)?>([^<>]*|<!\[CDATA\[[^<>]*\]\]>)</\1>")
BLOCK = re.compile(rb"<([A-Za-z_]+)(?: [^<>]*)?>.*?</\1>", re.DOTALL)


def loaded(path: Path, options: evoframe.FileOptions) -> tuple[Vox, evoframe.Design, bool]:
    """Return simulator and body of a file, as ``evoframe simulate`` does, and whether it is complete."""
    contents = Vox.interpret(path, options)
    if contents is None:
        raise RuntimeError("expected the contents of a VXA file, found none")
    layers = [
        evoframe.Layer(str(path), {"simulator": {"name": "vox", **contents.settings}}),
        evoframe.Layer("--set", {"simulator": dict(options.settings)}),
    ]
    vox = evoframe.load_config("quick", overrides=layers, plugins=PLUGINS).simulator.component
    if not isinstance(vox, Vox):
        raise TypeError(type(vox))
    [(_, design)] = contents.designs
    return vox, design, "duration" in contents.settings


def simulate(vox: Vox, design: evoframe.Design) -> None:
    """Simulate a few steps of a small body."""
    if design.roles[evoframe.MORPHOLOGY].size > MOST_CELLS:
        return
    try:
        brief = attrs.evolve(vox, step_limit=min(vox.step_limit, MOST_STEPS))
    except ValueError:  # another body would need more steps
        return
    record = evoframe.Record(tracks=("tip", "body"), initial=True)
    try:
        [outcome] = brief.simulate([design], record)
    except REFUSED:
        return
    going = np.ones(len(outcome.steps), bool)
    if outcome.diverged_at is not None:
        going = outcome.steps < outcome.diverged_at
    if not all(np.isfinite(track[going]).all() for track in outcome.tracks.values()):
        raise RuntimeError(f"not finite, although it diverged at {outcome.diverged_at}")


def as_written(vox: Vox) -> dict[str, Any]:
    """Return the settings in the precision of a file: a single-precision period, a name for each material."""
    palette = [attrs.evolve(given, name=given.name or f"material {given.code}") for given in vox.palette]
    written = {**attrs.asdict(vox), "palette": palette, "frequency": np.float32(1 / vox.frequency)}
    strain = abs(vox.temperature_amplitude - vox.temperature_base)
    if all(1 + strain * abs(given.expansion_coefficient) < vox.largest_size for given in vox.palette):
        del written["largest_size"], written["size_rule"]  # without an effect
    return written


def export(vox: Vox, design: evoframe.Design, complete: bool) -> None:
    """Write a body, read it, and compare."""
    try:
        exported = vox.export(design, "vxa")
    except REFUSED:
        return
    path = Path("again.vxa")
    path.write_bytes(exported.data)
    again, same, _ = loaded(path, evoframe.FileOptions())
    if complete and not exported.left_out and as_written(again) != as_written(vox):
        raise RuntimeError(f"settings differ after export:\n{vox}\n{again}")
    for role, array in design.roles.items():
        if not np.array_equal(array, same.roles[role]) and role != evoframe.CONTROLLER:
            raise RuntimeError(f"{role} differs after export")
    record = evoframe.Record(tracks=("tip",))
    if vox.key(design, record) != again.key(same, record):
        raise RuntimeError("offsets differ after export")


def test_one_input(data: bytes) -> None:
    path = Path("fuzzed.vxa")
    path.write_bytes(data)
    draw = random.Random(len(data))  # noqa: S311 - no secret depends on it
    options = evoframe.FileOptions(draw.choice(DIALECTS), settings=draw.choice(OVERRIDES))
    try:
        vox, design, complete = loaded(path, options)
    except REFUSED as error:
        if path.name not in str(error) and "--set" not in str(error):
            raise RuntimeError("the error does not name the file") from error
        return
    simulate(vox, design)
    export(vox, design, complete and not options.settings)


def replaced(data: bytes, found: re.Match[bytes], text: bytes) -> bytes:
    return data[: found.start()] + text + data[found.end() :]


def replace_text(data: bytes, draw: random.Random) -> bytes:
    """Replace the text of an element."""
    found = draw.choice(list(LEAF.finditer(data)))
    text = draw.choice(TEXTS).encode()
    return data[: found.start(2)] + text + data[found.end(2) :]


def move_block(data: bytes, draw: random.Random) -> bytes:
    """Remove, move or copy a block of elements."""
    found = draw.choice(list(BLOCK.finditer(data, draw.randrange(len(data)))) or list(BLOCK.finditer(data)))
    rest = replaced(data, found, b"") if draw.random() < 0.5 else data
    if draw.random() < 0.4:
        return rest
    at = draw.choice([at.start() for at in re.finditer(b"<", rest)] or [0])
    return rest[:at] + found[0] + rest[at:]


def replace_tag(data: bytes, draw: random.Random) -> bytes:
    """Replace the tag of an element."""
    found = draw.choice(list(LEAF.finditer(data)))
    tag = draw.choice(TAGS).encode()
    return replaced(data, found, b"<%b>%b</%b>" % (tag, found[2], tag))


def insert_element(data: bytes, draw: random.Random) -> bytes:
    """Insert an element after another."""
    found = draw.choice(list(LEAF.finditer(data)))
    tag, text = draw.choice(TAGS).encode(), draw.choice(TEXTS).encode()
    return replaced(data, found, b"%b<%b>%b</%b>" % (found[0], tag, text, tag))


MUTATIONS: tuple[Callable[[bytes, random.Random], bytes], ...] = (
    replace_text,
    replace_text,
    move_block,
    replace_tag,
    insert_element,
)


def mutated(data: bytes, max_size: int, seed: int) -> bytes:
    """Return *data* with whole elements changed, or mutated by libFuzzer."""
    draw = random.Random(seed)  # noqa: S311 - no secret depends on it
    if draw.random() < 0.3 or not LEAF.search(data):
        return atheris.Mutate(data, max_size)
    for _ in range(draw.choice((1, 1, 2, 4))):
        if LEAF.search(data):
            data = draw.choice(MUTATIONS)(data, draw)
    return data[:max_size]


def main() -> None:
    script, *given = [part if part.startswith("-") else str(Path(part).resolve()) for part in sys.argv]
    program = f"{sys.executable} {script}"  # libFuzzer restarts it to merge
    atheris.Setup([program, *given], test_one_input, custom_mutator=mutated)
    document._MOST_BYTES, document._MOST_ELEMENTS = 2**14, 2**9  # so that some files are too large
    warnings.simplefilter("error")  # no file may cause a warning
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        atheris.Fuzz()


if __name__ == "__main__":
    main()

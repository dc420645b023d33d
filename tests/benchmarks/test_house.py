"""The figures of a source tree equal those counted by hand."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.house import form_of

FILES = {
    "src/evoframe/__init__.py": '"""The core."""\n',
    "src/evoframe/a.py": (
        '"""A."""\n\nfrom evoframe import b\n\n__all__ = ["f"]\n\n\ndef f() -> int:\n'
        "    return _g() + _h() + _h()\n\n\ndef _g() -> int:\n    return b.one  # one\n\n\n"
        "def _h() -> int:\n    # two\n    return 2\n"
    ),
    "src/evoframe/b.py": "from evoframe.c import one\n",
    "src/evoframe/c.py": "def late():\n    from evoframe import b\n\n\none = 1\n",
    "plugins/kind/evoframe_kind/__init__.py": "import evoframe.a\n",
}


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def test_everything_is_counted(tree: Path) -> None:
    form = form_of(tree)
    assert form.folders == {"src/evoframe": 4, "plugins/kind/evoframe_kind": 1}
    assert form.circles == (frozenset({"evoframe.b", "evoframe.c"}),)
    assert form.chain == 3  # the plugin, a, and the circle
    assert sorted(form.functions) == [2, 2, 2, 3]
    assert (form.private, form.used_once) == (2, 1)
    assert form.lines == sum(text.count("\n") for text in FILES.values())
    assert form.code == 6 + 2


def test_this_source_has_no_circular_imports() -> None:
    assert form_of(Path(__file__).parents[2]).circles == ()

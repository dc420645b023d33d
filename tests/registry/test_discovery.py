"""Tests of the discovery of plugins: local modules, valid and invalid."""

from __future__ import annotations

import hashlib
import sys
from pathlib import Path

import pytest

from evoframe import PluginError
from evoframe.registry.discovery import discover


class TestLocalModules:
    MODULE = """
import attrs
from evoframe import hookimpl

@attrs.frozen
class Highest:
    domain = (-1e100, 1e100)
    def check(self, n): pass
    def aggregate(self, scores): return float(max(scores))

@hookimpl
def evoframe_aggregators():
    return {"highest": Highest}
"""

    def test_a_file_is_a_plugin(self, tmp_path: Path) -> None:
        path = tmp_path / "highest_of_all.py"
        path.write_text(self.MODULE)
        offer = discover([str(path)]).find("aggregator", "highest")
        assert str(offer.source) == "'highest_of_all' of highest_of_all local"

    @pytest.mark.skipif(sys.platform != "linux", reason="needs names of any bytes")
    def test_the_name_of_a_file_of_any_bytes_can_be_recorded(self, tmp_path: Path) -> None:
        path = tmp_path / "b\udcff.py"
        path.write_text(self.MODULE)
        offer = discover([str(path)]).find("aggregator", "highest")
        assert str(offer.source) == "'b?' of b? local"

    def test_a_file_has_the_checksum_of_its_source(self, tmp_path: Path) -> None:
        path = tmp_path / "checked_source.py"
        digests = []
        for text in (self.MODULE, f"{self.MODULE}# edited\n", self.MODULE):
            path.write_text(text)
            source = discover([str(path)]).find("aggregator", "highest").source
            assert source.digest == f"sha256:{hashlib.sha256(text.encode()).hexdigest()}"
            digests.append(source.digest)
        assert digests[0] == digests[2] != digests[1]

    def test_an_installed_plugin_has_a_version_and_no_checksum(self) -> None:
        assert {offer.source.digest for offer in discover().offers} == {""}

    @pytest.mark.parametrize("module", ["acme_checked", "acme_checked.plugin"])
    def test_a_package_has_the_checksum_of_all_its_python_files(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, module: str
    ) -> None:
        package = tmp_path / "acme_checked"
        (package / "inner").mkdir(parents=True)
        (package / "plugin.py").write_text(self.MODULE)
        (package / "__init__.py").write_text("from acme_checked.plugin import evoframe_aggregators\n")
        (package / "inner" / "helper.py").write_text("a = 1\n")
        monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])

        def digest() -> str:
            for name in [name for name in sys.modules if name.startswith("acme_checked")]:
                monkeypatch.delitem(sys.modules, name)
            return discover([module]).find("aggregator", "highest").source.digest

        before = digest()
        (package / "notes.txt").write_text("not Python")
        assert digest() == before
        (package / "inner" / "helper.py").write_text("a = 2\n")
        edited = digest()
        assert edited != before
        (package / "inner" / "helper.py").rename(package / "helper.py")
        assert digest() not in (before, edited)

    def test_a_module_in_the_working_directory_is_a_plugin(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        (tmp_path / "highest_beside.py").write_text(self.MODULE)
        monkeypatch.chdir(tmp_path)
        monkeypatch.setattr(sys, "path", [*sys.path])
        found = discover(["highest_beside"]).names("aggregator")
        assert found == sorted({"highest", *discover().names("aggregator")})
        assert found != discover().names("aggregator")

    @pytest.mark.parametrize(
        ("text", "cause"),
        [("1 / 0", "ZeroDivisionError"), ("x = 1", "hookimpl"), ("(", "SyntaxError")],
    )
    def test_a_faulty_module_is_an_error(self, tmp_path: Path, text: str, cause: str) -> None:
        path = tmp_path / "bad_local.py"
        path.write_text(text)
        with pytest.raises(PluginError, match=cause) as caught:
            discover([str(path)])
        assert caught.value.source == str(path)

    def test_a_module_named_like_one_of_python_does_not_replace_it(self, tmp_path: Path) -> None:
        path = tmp_path / "random.py"
        path.write_text(self.MODULE)
        assert "highest" in discover([str(path), str(path)]).names("aggregator")
        assert hasattr(sys.modules["random"], "SystemRandom")

    @pytest.mark.parametrize(
        ("module", "cause"), [("nowhere.py", "such file"), ("nowhere_at_all", "ModuleNotFoundError")]
    )
    def test_a_missing_module_is_an_error(self, module: str, cause: str) -> None:
        with pytest.raises(PluginError, match=cause) as caught:
            discover([module])
        assert caught.value.source == module

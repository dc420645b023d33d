"""Tests of layers of settings: files, the files that they extend, and overrides."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, strategies as st

from evoframe import ConfigurationError, RunConfig
from evoframe.config.layers import Layer, Layers, layers_in, layers_of, preset_names, read_layers
from evoframe.config.resolve import load_config
from evoframe.documents.trees import leaves
from evoframe.registry.discovery import discover
from evoframe.registry.registry import Plugins

Load = Callable[..., RunConfig]


@pytest.fixture(scope="module")
def installed() -> Plugins:
    return discover()


class TestMerging:
    def test_another_component_does_not_inherit_options(self, installed: Plugins) -> None:
        weights = 'aggregator={name="wm", weights=[0.7, 0.3]}'
        config = load_config("paper", overrides=[weights, "aggregator=hm"], plugins=installed)
        assert config.aggregator.name == "hm"
        assert "weights" not in config.tables()["aggregator"]

    def test_the_same_component_keeps_its_options(self, installed: Plugins) -> None:
        config = load_config(
            "paper", overrides=["simulator.duration=0.08", "simulator=vox"], plugins=installed
        )
        assert config.tables()["simulator"]["duration"] == 0.08

    def test_a_file_extends_paper_by_default(self, installed: Plugins, tmp_path: Path) -> None:
        path = tmp_path / "my.toml"
        path.write_text('[aggregator]\nname = "wm"\nweights = [0.7, 0.3]\n')
        config = load_config(path, plugins=installed)
        assert config.tables()["aggregator"]["weights"] == [0.7, 0.3]
        assert config.run.generations == 200
        assert config.label == "my"
        path.write_text('extends = "quick"\naggregator = "am"\n')
        assert load_config(path, plugins=installed).run.generations == 5

    def test_a_file_may_extend_a_file_in_the_same_directory(self, installed: Plugins, tmp_path: Path) -> None:
        (tmp_path / "base.toml").write_text("[run]\ngenerations = 7\n")
        (tmp_path / "top.toml").write_text('extends = "base.toml"\naggregator = "am"\n')
        assert load_config(tmp_path / "top.toml", plugins=installed).run.generations == 7

    def test_provenance_is_not_a_setting(self, toy_config: Load, toy_file: Path) -> None:
        plain = toy_config()
        toy_file.write_text(toy_file.read_text() + '\n[provenance]\nevoframe = "0.1.0"\n')
        assert toy_config() == plain

    @pytest.mark.parametrize(
        ("text", "value"),
        [
            ("2", 2),
            ("0.5", 0.5),
            ("true", True),
            ("hm", "hm"),
            ('"a b"', "a b"),
            ("[1, 2]", [1, 2]),
            ("1e-3", 1e-3),
        ],
    )
    def test_an_override_is_a_toml_value_or_a_bare_word(self, text: str, value: Any) -> None:
        tree = read_layers("paper", overrides=[f"aggregator.x={text}"]).merged()
        assert tree["aggregator"]["x"] == value


class TestRefusal:
    def test_invalid_toml_is_located(self, toy_config: Load, toy_file: Path) -> None:
        toy_file.write_text("[run\nseed = 1")
        with pytest.raises(ConfigurationError, match="line 1") as caught:
            toy_config()
        assert caught.value.source == str(toy_file)
        toy_file.write_bytes(b"\xff\xfe")
        with pytest.raises(ConfigurationError, match="UTF-8") as caught:
            toy_config()
        assert caught.value.source == str(toy_file)

    @pytest.mark.parametrize(
        "text",
        [
            "x = " + "[" * 5000,
            "x = " + "1" * 5000,
            'extends = "a\\u0000.toml"',
            'extends = ""',
            "extends = 3",
            'extends = "."',
        ],
        ids=lambda text: text[:20],
    )
    def test_an_extreme_file_is_refused(self, toy_config: Load, toy_file: Path, text: str) -> None:
        toy_file.write_text(text)
        with pytest.raises(ConfigurationError):
            toy_config()

    def test_a_missing_file_is_named(self, tmp_path: Path, toy_plugins: Plugins) -> None:
        with pytest.raises(ConfigurationError, match="no such preset or file") as caught:
            load_config(tmp_path / "nowhere.toml", plugins=toy_plugins)
        assert caught.value.source == str(tmp_path / "nowhere.toml")

    def test_an_unknown_preset_is_answered_with_the_known_ones(self, toy_plugins: Plugins) -> None:
        with pytest.raises(ConfigurationError) as caught:
            load_config("papr", plugins=toy_plugins)
        assert caught.value.source == "papr"
        assert "'paper'" in str(caught.value)
        assert all(name in str(caught.value) for name in preset_names())

    @pytest.mark.parametrize("base", ["papr", "b.toml"])
    def test_a_missing_base_is_named_with_the_file_that_extends_it(
        self, tmp_path: Path, toy_plugins: Plugins, base: str
    ) -> None:
        (tmp_path / "a.toml").write_text(f'extends = "{base}"')
        with pytest.raises(ConfigurationError, match=base) as caught:
            load_config(tmp_path / "a.toml", plugins=toy_plugins)
        assert (caught.value.source, caught.value.key) == (str(tmp_path / "a.toml"), "extends")

    def test_files_that_extend_each_other_are_refused(self, tmp_path: Path, toy_plugins: Plugins) -> None:
        (tmp_path / "a.toml").write_text('extends = "b.toml"')
        (tmp_path / "b.toml").write_text('extends = "a.toml"')
        with pytest.raises(ConfigurationError, match=r"a\.toml -> .*b\.toml -> .*a\.toml") as caught:
            load_config(tmp_path / "a.toml", plugins=toy_plugins)
        assert caught.value.key == "extends"

    def test_a_file_that_extends_itself_by_another_name_is_refused(
        self, tmp_path: Path, toy_plugins: Plugins
    ) -> None:
        (tmp_path / "folder").mkdir()
        (tmp_path / "a.toml").write_text('extends = "folder/../a.toml"')
        with pytest.raises(ConfigurationError, match=r"a\.toml -> .*a\.toml") as caught:
            load_config(tmp_path / "a.toml", plugins=toy_plugins)
        assert caught.value.key == "extends"

    @pytest.mark.parametrize(
        "text",
        [f"[{'a.' * 3000}a]", f"{'a.' * 3000}a = 1", f"a = {'[' * 64}{']' * 64}", "a.b = [{c = [[]]}]"],
    )
    def test_only_deep_tables_and_lists_are_refused_for_their_depth(
        self, toy_config: Load, toy_file: Path, text: str
    ) -> None:
        toy_file.write_text(text)
        expected = "64 deep" if len(text) > 30 else "unknown key"
        with pytest.raises(ConfigurationError, match=expected):
            toy_config()

    def test_a_deep_key_is_refused(self, toy_config: Load) -> None:
        with pytest.raises(ConfigurationError, match="64 deep") as caught:
            toy_config(f"{'a.' * 3000}a=1")
        assert caught.value.source.startswith("--set a.a.a.")
        assert len(caught.value.source) < 100

    def test_an_endless_file_is_refused(self, toy_plugins: Plugins) -> None:
        with pytest.raises(ConfigurationError, match="16 MiB") as caught:
            load_config("/dev/zero", plugins=toy_plugins)
        assert caught.value.source == "/dev/zero"

    @pytest.mark.parametrize("text", ["aggregator", "=hm", "a b=1", "aggregator=[1", "run.seed=1\nrun.x=2"])
    def test_an_invalid_override_is_refused(self, toy_config: Load, text: str) -> None:
        with pytest.raises(ConfigurationError) as caught:
            toy_config(text)
        assert caught.value.source == f"--set {text}"


def components(names: st.SearchStrategy[str]) -> st.SearchStrategy[Any]:
    options = st.dictionaries(st.sampled_from(["n", "weights"]), st.integers(0, 3), max_size=2)
    return names | st.builds(lambda name, given: {"name": name, **given}, names, options)


values = st.recursive(
    st.integers(0, 3) | st.lists(st.integers(0, 3), max_size=2),
    lambda inner: st.dictionaries(st.sampled_from(["x", "y"]), inner, min_size=1, max_size=2),
    max_leaves=4,
)
trees = st.fixed_dictionaries(
    {},
    optional={"run": values, "aggregator": components(st.sampled_from(["hm", "wm"])), "simulator": values},
)
stacks = st.lists(trees, max_size=4).map(
    lambda given: Layers(()).under([Layer(f"layer {number}", tree) for number, tree in enumerate(given)])
)


def at(tree: Any, key: str) -> Any:
    for part in key.split("."):
        tree = tree[part]
    return tree


class TestLayers:
    @given(stacks)
    def test_the_top_layer_wins(self, stack: Layers) -> None:
        if stack.layers:
            top, merged = stack.layers[-1].tree, stack.merged()
            assert all(at(merged, key) == value for key, value in leaves(top) if key)

    @given(stacks)
    def test_every_value_comes_from_its_origin(self, stack: Layers) -> None:
        by_origin = {layer.origin: layer.tree for layer in stack.layers}
        for key, value in leaves(stack.merged()):
            if key:
                assert at(by_origin[stack.origin(tuple(key.split(".")))], key) == value

    @given(stacks, stacks)
    def test_merging_lower_layers_first_gives_the_same(self, below: Layers, above: Layers) -> None:
        whole = Layers((*below.layers, *above.layers))
        parted = Layers((Layer("below", below.merged()), *above.layers))
        assert parted.merged() == whole.merged()

    @given(stacks)
    def test_repeating_the_top_layer_changes_nothing(self, stack: Layers) -> None:
        assert Layers((*stack.layers, *stack.layers[-1:])).merged() == stack.merged()

    @given(stacks)
    def test_a_component_has_only_its_own_options(self, stack: Layers) -> None:
        """Options of another component in a lower layer are dropped."""
        layers = [layer.tree["aggregator"] for layer in stack.layers if "aggregator" in layer.tree]
        if layers:
            same = list(
                itertools.takewhile(lambda table: table["name"] == layers[-1]["name"], reversed(layers))
            )
            expected = {key: value for table in reversed(same) for key, value in table.items()}
            assert stack.merged()["aggregator"] == expected

    @given(stacks)
    def test_removed_keys_are_in_no_layer(self, stack: Layers) -> None:
        merged = stack.without("run", "aggregator").merged()
        assert merged == {key: value for key, value in stack.merged().items() if key == "simulator"}

    def test_a_string_is_not_a_list_of_overrides(self) -> None:
        with pytest.raises(TypeError, match="overrides"):
            Layers(()).under("run.seed=2")

    def test_the_origin_of_an_unset_value_is_that_of_the_nearest_table(self) -> None:
        stack = Layers((Layer("below", {"run": {"seed": 1}}), Layer("above", {"aggregator": {"name": "hm"}})))
        assert stack.origin(("run", "seed")) == stack.origin(("run", "sede")) == "below"
        assert stack.origin(("aggregator", "weights[2]")) == "above"
        assert stack.origin(("run",), ("aggregator",)) == "above"  # the latest of several


def test_none_leaves_a_dotted_key_unset() -> None:
    [layer] = layers_of({"run.seed": 3, "executor.workers": None})
    assert (layer.origin, layer.tree) == ("run.seed=3", {"run": {"seed": 3}})


def test_what_is_unset_later_does_not_unset_an_earlier_key() -> None:
    assert Layers((*layers_of({"run.seed": 3}, {"run.seed": None}),)).merged() == {"run": {"seed": 3}}
    assert Layers((*layers_of({"run.seed": 3}, {"run.seed": 4}),)).merged() == {"run": {"seed": 4}}


def test_extends_and_provenance_of_a_run_are_not_settings() -> None:
    tables = {"extends": False, "run": {"seed": 3}, "provenance": {"evoframe": "0.1.0"}}
    assert layers_in(tables, "config.toml").merged() == {"run": {"seed": 3}}

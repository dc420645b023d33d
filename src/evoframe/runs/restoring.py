"""The configuration of a saved run, and its loop as it was after the last saved turn."""

from __future__ import annotations

from collections.abc import Sequence

from evoframe.config import Layer, layers_in, resolve_layers
from evoframe.contract import RunConfig
from evoframe.documents import differences
from evoframe.errors import ComponentError, ConfigurationError, InputError
from evoframe.evolution import Coevolution
from evoframe.record import CONFIG_FILE, Run
from evoframe.registry import Plugins
from evoframe.runs.blame import completed

__all__ = ["configuration_of", "listed", "restore"]


def configuration_of(run: Run, overrides: Sequence[str | Layer], plugins: Plugins) -> RunConfig:
    """Return the resolved configuration of a run.

    Settings that determine the result must be unchanged since the start, with and without the overrides.

    Args:
        run: The run.
        overrides: Settings of the executor.
        plugins: The available plugins.

    Raises:
        ConfigurationError: The configuration is invalid, or changed since the start; the text lists changes.
        InputError: The run is damaged.
    """
    path = run.directory / CONFIG_FILE
    layers = layers_in(run.config, str(path))
    config = resolve_layers(layers.under(overrides), path.stem, plugins)
    began = run.configuration() if run.begun else resolve_layers(layers, path.stem, plugins).deciding()
    if others := differences(began, config.deciding()):
        problem = "the configuration differs from that with which the run started"
        todo = f"undo these changes, or start a new run: evoframe run {path}"
        raise ConfigurationError(f"{listed(problem, others)}\n  {todo}", source=run.directory)
    return config


def restore(coevolution: Coevolution, saved: Run, config: RunConfig) -> None:
    """Restore the loop to the end of the last turn.

    Raises:
        InputError: The state is missing or invalid.
    """
    state, last = saved.state(), saved.last_turn()
    if last is None and not state:
        return
    try:
        coevolution.restore(state)
    except Exception as error:
        cause = f"missing {error}" if isinstance(error, KeyError) else str(error)
        if isinstance(error, ComponentError):
            cause = str(completed(error, config, f"state after turn {last}"))
        raise InputError(f"cannot be restored: {cause}", source=saved.directory, key="state") from error
    if coevolution.turn != last:
        problem = f"expected the state after turn {last}, found that after turn {coevolution.turn}"
        raise InputError(problem, source=saved.directory, key="state")


def listed(problem: str, lines: Sequence[str]) -> str:
    """Return a problem with lines that explain it."""
    return "\n  ".join([f"{problem}:", *lines])

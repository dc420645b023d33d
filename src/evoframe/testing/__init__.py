"""Contract tests that authors of plugins subclass: the laws of :mod:`evoframe.contract`, one test each.

.. code-block:: python

    from evoframe.testing import AggregatorContract


    class TestMedian(AggregatorContract):
        component = Median()

They need ``pip install 'evoframe[testing]'``.
"""

try:
    import hypothesis  # noqa: F401
    import pytest
except ImportError as error:
    raise ImportError(
        "evoframe.testing needs pytest and hypothesis; install them with: pip install 'evoframe[testing]'"
    ) from error

# A failing law then shows the values that it compared, as a test of the plugin's own would.
pytest.register_assert_rewrite(
    *(
        f"evoframe.testing.{module}"
        for module in (
            "aggregators",
            "components",
            "encoders",
            "evolvers",
            "executors",
            "laws",
            "objectives",
            "simulators",
            "strategies",
        )
    )
)

from evoframe.testing.aggregators import AggregatorContract  # noqa: E402
from evoframe.testing.encoders import EncoderContract  # noqa: E402
from evoframe.testing.evolvers import EvolverContract  # noqa: E402
from evoframe.testing.executors import ExecutorContract  # noqa: E402
from evoframe.testing.objectives import ObjectiveContract  # noqa: E402
from evoframe.testing.simulators import SimulatorContract  # noqa: E402
from evoframe.testing.strategies import CollaborationStrategyContract  # noqa: E402

__all__ = [
    "AggregatorContract",
    "CollaborationStrategyContract",
    "EncoderContract",
    "EvolverContract",
    "ExecutorContract",
    "ObjectiveContract",
    "SimulatorContract",
]

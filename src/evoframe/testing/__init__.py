"""Contract tests that plugin authors subclass: one test for each law of :mod:`evoframe.contract`.

.. code-block:: python

    from evoframe.testing import AggregatorContract


    class TestMedian(AggregatorContract):
        component = Median()

They require pytest and hypothesis: ``pip install '.[testing]'`` in a checkout of evoframe.
"""

try:
    import hypothesis  # noqa: F401
    import pytest
except ImportError as error:
    raise ImportError(
        "evoframe.testing requires pytest and hypothesis; "
        "in a checkout of evoframe, install them with: pip install '.[testing]'"
    ) from error

# Failing laws then show the compared values, like assertions in the plugin's own tests.
pytest.register_assert_rewrite(
    *(
        f"evoframe.testing.{module}"
        for module in (
            "aggregators",
            "components",
            "credits",
            "encoders",
            "encounters",
            "evolvers",
            "evolving",
            "executors",
            "laws",
            "objectives",
            "roles",
            "seeding",
            "simulators",
            "strategies",
            "strategy_runs",
        )
    )
)

from evoframe.testing.aggregators import AggregatorContract  # noqa: E402
from evoframe.testing.credits import CreditContract  # noqa: E402
from evoframe.testing.encoders import EncoderContract  # noqa: E402
from evoframe.testing.evolvers import EvolverContract  # noqa: E402
from evoframe.testing.executors import ExecutorContract  # noqa: E402
from evoframe.testing.objectives import ObjectiveContract  # noqa: E402
from evoframe.testing.roles import RoleProviderContract  # noqa: E402
from evoframe.testing.simulators import SimulatorContract  # noqa: E402
from evoframe.testing.strategies import CollaborationStrategyContract  # noqa: E402

__all__ = [
    "AggregatorContract",
    "CollaborationStrategyContract",
    "CreditContract",
    "EncoderContract",
    "EvolverContract",
    "ExecutorContract",
    "ObjectiveContract",
    "RoleProviderContract",
    "SimulatorContract",
]

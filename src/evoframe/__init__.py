"""Cooperative coevolution of soft robots: a small core, and plugins for everything else.

This module is the public API: what a plugin author implements (:data:`hookimpl`, the protocols, the values,
the errors) and what a user calls from Python (:func:`run`, :func:`load_run`, :func:`verify`,
:class:`Coevolution`).
"""

from evoframe._version import __version__
from evoframe.config.layers import Layer
from evoframe.config.resolve import load_config
from evoframe.contract.config import Chosen, PopulationConfig, RunConfig, RunSettings
from evoframe.contract.drawings import Geometry, GeometryPart, NetworkGraph, NetworkLink
from evoframe.contract.protocols import (
    Aggregator,
    CollaborationStrategy,
    Encoder,
    Evolver,
    EvolverRun,
    Executor,
    ExecutorRun,
    Network,
    Objective,
    Simulator,
)
from evoframe.contract.values import (
    BestPair,
    Design,
    Export,
    Member,
    Outcome,
    Pair,
    PopulationReport,
    Record,
    Scores,
    Turn,
    Variant,
    Workload,
)
from evoframe.contract.voxels import CONTRACTILE, CONTROLLER, EMPTY, MORPHOLOGY, PASSIVE
from evoframe.designs.verifying import verify
from evoframe.errors import (
    ConfigurationError,
    EvoframeError,
    InputError,
    PluginError,
    PluginWarning,
    RunError,
    WorkerError,
)
from evoframe.evolution.coevolution import Coevolution
from evoframe.evolution.evaluation import Evaluator, Score
from evoframe.evolution.population import Population
from evoframe.notebook import load_study
from evoframe.record.run import Champion, Run, load_run
from evoframe.record.verification import Finding, Verification
from evoframe.registry.discovery import discover
from evoframe.registry.hookspecs import hookimpl
from evoframe.registry.registry import Plugins, suggestion
from evoframe.robustness.api import robustness
from evoframe.robustness.measurement import Body, Divergence, Robustness, Setting
from evoframe.runs.execution import assemble, run
from evoframe.runs.resuming import resume
from evoframe.workers.cores import available_cores
from evoframe.workers.processes import WorkerProcesses

__all__ = [
    "CONTRACTILE",
    "CONTROLLER",
    "EMPTY",
    "MORPHOLOGY",
    "PASSIVE",
    "Aggregator",
    "BestPair",
    "Body",
    "Champion",
    "Chosen",
    "Coevolution",
    "CollaborationStrategy",
    "ConfigurationError",
    "Design",
    "Divergence",
    "Encoder",
    "Evaluator",
    "EvoframeError",
    "Evolver",
    "EvolverRun",
    "Executor",
    "ExecutorRun",
    "Export",
    "Finding",
    "Geometry",
    "GeometryPart",
    "InputError",
    "Layer",
    "Member",
    "Network",
    "NetworkGraph",
    "NetworkLink",
    "Objective",
    "Outcome",
    "Pair",
    "PluginError",
    "PluginWarning",
    "Plugins",
    "Population",
    "PopulationConfig",
    "PopulationReport",
    "Record",
    "Robustness",
    "Run",
    "RunConfig",
    "RunError",
    "RunSettings",
    "Score",
    "Scores",
    "Setting",
    "Simulator",
    "Turn",
    "Variant",
    "Verification",
    "WorkerError",
    "WorkerProcesses",
    "Workload",
    "__version__",
    "assemble",
    "available_cores",
    "discover",
    "hookimpl",
    "load_config",
    "load_run",
    "load_study",
    "resume",
    "robustness",
    "run",
    "suggestion",
    "verify",
]

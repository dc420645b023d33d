"""Cooperative coevolution of soft robots: a small core, and plugins for everything else.

This module is the public API: what a plugin author implements (:data:`hookimpl`, the protocols, the values,
the errors) and what a user calls from Python (:func:`run`, :func:`load_run`, :func:`verify`,
:class:`Coevolution`).
"""

from evoframe._version import __version__
from evoframe.coevolution import Coevolution
from evoframe.config import Chosen, PopulationConfig, RunConfig, RunSettings
from evoframe.cores import available_cores
from evoframe.discovery import discover
from evoframe.drawings import Geometry, GeometryPart, NetworkGraph, NetworkLink
from evoframe.errors import (
    ConfigurationError,
    EvoframeError,
    InputError,
    PluginError,
    PluginWarning,
    RunError,
    WorkerError,
)
from evoframe.evaluation import Evaluator, Score
from evoframe.hookspecs import hookimpl
from evoframe.layers import Layer
from evoframe.loading import Champion, Run, load_run
from evoframe.measurement import Body, Divergence, Robustness, Setting
from evoframe.notebook import load_study
from evoframe.plugins import Plugins, suggestion
from evoframe.population import Population
from evoframe.processes import WorkerProcesses
from evoframe.protocols import (
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
from evoframe.resolve import load_config
from evoframe.resuming import resume
from evoframe.robustness import robustness
from evoframe.run import assemble, run
from evoframe.values import (
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
from evoframe.verification import Finding, Verification
from evoframe.verify import verify
from evoframe.voxels import CONTRACTILE, CONTROLLER, EMPTY, MORPHOLOGY, PASSIVE

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

# The names of the public API and their modules, for type checkers and for lazy_loader in __init__.py.

from ._version import __version__ as __version__
from .analysis.api import load_study as load_study, report as report
from .analysis.statistics import Correction as Correction
from .config.layers import Layer as Layer
from .config.resolve import load_config as load_config
from .contract.choosing import sizes_of as sizes_of, started as started
from .contract.config import (
    ADDED_LATER as ADDED_LATER,
    Chosen as Chosen,
    PopulationConfig as PopulationConfig,
    RoleConfig as RoleConfig,
    RunConfig as RunConfig,
    RunSettings as RunSettings,
    Source as Source,
    StartSettings as StartSettings,
)
from .contract.drawings import (
    Geometry as Geometry,
    GeometryPart as GeometryPart,
    NetworkGraph as NetworkGraph,
    NetworkLink as NetworkLink,
)
from .contract.optional import (
    SupportsArrayTypes as SupportsArrayTypes,
    SupportsBatches as SupportsBatches,
    SupportsBitGeneration as SupportsBitGeneration,
    SupportsDesignMeasures as SupportsDesignMeasures,
    SupportsDialects as SupportsDialects,
    SupportsDuration as SupportsDuration,
    SupportsEach as SupportsEach,
    SupportsExemptions as SupportsExemptions,
    SupportsExport as SupportsExport,
    SupportsFitnessUnit as SupportsFitnessUnit,
    SupportsGeometry as SupportsGeometry,
    SupportsGraph as SupportsGraph,
    SupportsInputNames as SupportsInputNames,
    SupportsLoad as SupportsLoad,
    SupportsMeasures as SupportsMeasures,
    SupportsMemory as SupportsMemory,
    SupportsObjective as SupportsObjective,
    SupportsOutcomeMeasures as SupportsOutcomeMeasures,
    SupportsOutputNames as SupportsOutputNames,
    SupportsProvenance as SupportsProvenance,
    SupportsPublished as SupportsPublished,
    SupportsRandomControllers as SupportsRandomControllers,
    SupportsReading as SupportsReading,
    SupportsSeeds as SupportsSeeds,
    SupportsSettings as SupportsSettings,
    SupportsSizes as SupportsSizes,
    SupportsUnit as SupportsUnit,
    SupportsVariants as SupportsVariants,
    SupportsWants as SupportsWants,
    SupportsWholeDesigns as SupportsWholeDesigns,
    SupportsWindow as SupportsWindow,
    Variant as Variant,
)
from .contract.protocols import (
    Aggregator as Aggregator,
    CollaborationRun as CollaborationRun,
    CollaborationStrategy as CollaborationStrategy,
    Credit as Credit,
    Encoder as Encoder,
    Evolver as Evolver,
    EvolverRun as EvolverRun,
    Executor as Executor,
    ExecutorRun as ExecutorRun,
    Network as Network,
    Objective as Objective,
    RoleProvider as RoleProvider,
    RoleRun as RoleRun,
    Simulator as Simulator,
)
from .contract.values import (
    Archived as Archived,
    ArrayType as ArrayType,
    BestPair as BestPair,
    Choice as Choice,
    Design as Design,
    Export as Export,
    FileContents as FileContents,
    FileOptions as FileOptions,
    Judged as Judged,
    Member as Member,
    Outcome as Outcome,
    Pair as Pair,
    PopulationReport as PopulationReport,
    Record as Record,
    Score as Score,
    ScoredMeetings as ScoredMeetings,
    Scores as Scores,
    Turn as Turn,
    Workload as Workload,
)
from .contract.voxels import (
    CONTRACTILE as CONTRACTILE,
    CONTROLLER as CONTROLLER,
    EMPTY as EMPTY,
    MORPHOLOGY as MORPHOLOGY,
    PASSIVE as PASSIVE,
)
from .designs.verifying import verify as verify
from .documents.structuring import StructureError as StructureError, structure as structure
from .errors import (
    ConfigurationError as ConfigurationError,
    EvoframeError as EvoframeError,
    InputError as InputError,
    PluginError as PluginError,
    PluginWarning as PluginWarning,
    RunError as RunError,
    WorkerError as WorkerError,
)
from .evolution.assembly import assemble as assemble
from .evolution.coevolution import Coevolution as Coevolution
from .evolution.evaluation import Evaluator as Evaluator
from .evolution.population import Population as Population
from .messages import suggestion as suggestion
from .record.champion import Champion as Champion
from .record.run import Report as Report, Run as Run, load_run as load_run, open_run as open_run
from .record.verification import Finding as Finding, Verification as Verification
from .registry.discovery import discover as discover
from .registry.hookspecs import hookimpl as hookimpl
from .registry.registry import Plugins as Plugins
from .robustness.api import measure_robustness as measure_robustness
from .robustness.measurement import (
    Body as Body,
    Divergence as Divergence,
    Robustness as Robustness,
    Setting as Setting,
)
from .runs.resuming import resume as resume
from .runs.starting import run as run
from .study.api import (
    StudyPlan as StudyPlan,
    StudyResult as StudyResult,
    plan_study as plan_study,
    run_study as run_study,
)
from .workers.cores import available_cores as available_cores
from .workers.processes import WorkerProcesses as WorkerProcesses

__all__: list[str]

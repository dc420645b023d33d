"""Worker processes, and the number of available cores."""

from evoframe.workers.cores import available_cores
from evoframe.workers.processes import WorkerProcesses

__all__ = ["WorkerProcesses", "available_cores"]

"""Worker processes, and the number of available cores."""

from evoframe.workers.child import begin, report, stop_requested
from evoframe.workers.cores import available_cores
from evoframe.workers.processes import WorkerProcesses

__all__ = ["WorkerProcesses", "available_cores", "begin", "report", "stop_requested"]

"""Maps a step over jobs: in this process, on processes of this machine, or on a Dask scheduler that the user names. Knows nothing of the work."""

from pipeline.execution.jobs import map_divisible, map_jobs
from pipeline.execution.machine import cores, give_memory_back, pin_instructions, single_thread
from pipeline.execution.progress import Progress, Voice, tell, track
from pipeline.execution.queue import Lost

__all__ = [
    "Lost",
    "Progress",
    "Voice",
    "cores",
    "give_memory_back",
    "map_divisible",
    "map_jobs",
    "pin_instructions",
    "single_thread",
    "tell",
    "track",
]

"""Data-parallel training on the cores of one machine: processes that share each batch and average their gradients.

On small networks a second torch thread gains next to nothing, a second process nearly doubles the speed.
"""

import multiprocessing
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import torch
from torch import Tensor, distributed

from pipeline.errors import SfgenError

LEAVE = 30.0  # seconds that the others get to end when the first has


@dataclass(frozen=True, slots=True)
class ProcessGroup:
    """Member `rank` of `size` processes."""

    rank: int = 0
    size: int = 1

    def share(self, batch: int) -> slice:
        """Return the rows of a batch that this member computes: equal shares, so that the mean of means is the mean."""
        if batch % self.size:
            raise SfgenError(f"a batch of {batch} cannot be shared by {self.size} processes", "set train.workers to 1")
        part = batch // self.size
        return slice(self.rank * part, (self.rank + 1) * part)

    def average(self, parameters: Sequence[Tensor], terms: Tensor) -> Tensor:
        """Replace the gradients by their mean over the group; return the mean of `terms` (n,)."""
        if self.size == 1:
            return terms
        gradients = [p.grad for p in parameters if p.grad is not None]
        flat = torch.cat([*(g.flatten() for g in gradients), terms])
        distributed.all_reduce(flat)
        flat /= self.size
        *means, terms = flat.split([*(g.numel() for g in gradients), len(terms)])
        for gradient, mean in zip(gradients, means, strict=True):
            gradient.copy_(mean.view_as(gradient))
        return terms


ALONE = ProcessGroup()


@contextmanager
def spawn_group(size: int, work: Callable[[ProcessGroup], None]) -> Iterator[None]:
    """Make this process the first of a group whose others run `work`, each in a process of its own; `work` is importable by name.

    Raises SfgenError when one of them failed.
    """
    if size == 1:
        yield
        return
    context = multiprocessing.get_context("spawn")
    with TemporaryDirectory() as folder:
        meeting = f"file://{Path(folder) / 'meeting'}"
        others = [
            context.Process(target=_run_member, args=(meeting, ProcessGroup(rank, size), work), daemon=True) for rank in range(1, size)
        ]
        for process in others:
            process.start()
        try:
            distributed.init_process_group("gloo", init_method=meeting, rank=0, world_size=size)
            yield
            for process in others:
                process.join(LEAVE)
            if failed := [p.exitcode for p in others if p.exitcode]:
                raise SfgenError(f"{len(failed)} of {size} training processes failed", "see the log above, or set train.workers to 1")
        finally:
            for process in others:
                process.terminate()
            if distributed.is_initialized():
                distributed.destroy_process_group()


def _run_member(meeting: str, group: ProcessGroup, work: Callable[[ProcessGroup], None]) -> None:
    distributed.init_process_group("gloo", init_method=meeting, rank=group.rank, world_size=group.size)
    try:
        work(group)
    finally:
        distributed.destroy_process_group()

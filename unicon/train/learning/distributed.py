"""Several processes that learn one policy: what they have to agree on, through torch.distributed.

``torchrun`` starts the processes and tells each its number; alone, a process is all of the world and
nothing here does anything. Every process simulates its own environments.
"""

from __future__ import annotations

import os
from collections.abc import Iterable

import torch
from torch import Tensor, distributed

from unicon.errors import UniconError
from unicon.train.learning.normalizer import Moments, merge


class World:
    """The processes that train together; this one alone where there are no others."""

    def __init__(self, rank: int = 0, size: int = 1) -> None:
        self.rank = rank
        self.size = size

    @property
    def leads(self) -> bool:
        """Whether this process writes the logs and the files."""
        return self.rank == 0

    def average_gradients(self, parameters: Iterable[Tensor]) -> None:
        """Replace each gradient by its mean over the processes, all in one message."""
        if self.size == 1:
            return
        gradients = [p.grad for p in parameters if p.grad is not None]
        flat = torch.cat([gradient.flatten() for gradient in gradients])
        self._sum(flat)
        flat /= self.size
        start = 0
        for gradient in gradients:
            gradient.copy_(flat[start : start + gradient.numel()].view_as(gradient))
            start += gradient.numel()

    def sum(self, values: Tensor) -> Tensor:
        """Return the sum of a tensor over the processes."""
        if self.size > 1:
            values = values.clone()
            self._sum(values)
        return values

    def mean(self, value: float) -> float:
        """Return the mean of a number over the processes."""
        if self.size == 1:
            return value
        return float(self.sum(torch.tensor(value, dtype=torch.float64))) / self.size

    def any(self, flags: list[bool]) -> list[bool]:
        """Return for each flag whether it is set in some process."""
        if self.size == 1:
            return flags
        return [count > 0 for count in self.sum(torch.tensor([int(flag) for flag in flags])).tolist()]

    def merge_moments(self, moments: Moments) -> Moments:
        """Return the moments of all processes' observations together, the same in each to the bit."""
        if self.size == 1:
            return moments
        mine = torch.cat([moments.count[None], moments.mean, moments.variance])
        parts = [torch.empty_like(mine) for _ in range(self.size)]
        distributed.all_gather(parts, mine)
        size = len(moments.mean)
        merged = Moments(parts[0][0], parts[0][1 : size + 1], parts[0][size + 1 :])
        for part in parts[1:]:
            merged = merge(merged, Moments(part[0], part[1 : size + 1], part[size + 1 :]))
        return merged

    def copy_from_leader(self, tensors: Iterable[Tensor]) -> None:
        """Overwrite tensors by those of the first process."""
        if self.size > 1:
            for tensor in tensors:
                distributed.broadcast(tensor, src=0)

    def wait(self) -> None:
        """Go on when all processes are here."""
        if self.size > 1:
            distributed.barrier()

    def leave(self) -> None:
        """Take leave of the other processes."""
        if self.size > 1:
            distributed.destroy_process_group()

    def _sum(self, values: Tensor) -> None:
        if distributed.get_backend() == "nccl" and not values.is_cuda:
            on_gpu = values.cuda()
            distributed.all_reduce(on_gpu)
            values.copy_(on_gpu)
        else:
            distributed.all_reduce(values)


def join_world(device: torch.device) -> World:
    """Return the world that ``torchrun`` made, or that of this process alone.

    Raises:
        UniconError: when the other processes cannot be reached.
    """
    size = int(os.environ.get("WORLD_SIZE", "1"))
    if size == 1:
        return World()
    try:
        distributed.init_process_group("nccl" if device.type == "cuda" else "gloo")
    except (RuntimeError, ValueError, OSError) as error:
        first = str(error).splitlines()[0]
        raise UniconError(
            f"the {size} training processes cannot reach each other ({first}); start them with torchrun"
        ) from error
    return World(distributed.get_rank(), size)

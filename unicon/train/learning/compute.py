"""Where the networks are computed: device, threads and the type of their hidden layers."""

from __future__ import annotations

import os

import torch

from unicon.errors import UniconError


def choose_device(name: str) -> torch.device:
    """Return the device for ``auto``, ``cpu`` or ``cuda``; with several processes each has its own GPU.

    Raises:
        UniconError: when there is no GPU that torch can use.
    """
    if name == "cpu" or (name == "auto" and not torch.cuda.is_available()):
        return torch.device("cpu")
    if not torch.cuda.is_available():
        raise UniconError("learner.device is 'cuda', but torch finds no GPU here; set learner.device=cpu")
    index = int(os.environ.get("LOCAL_RANK", "0")) % torch.cuda.device_count()
    torch.cuda.set_device(index)
    return torch.device("cuda", index)


def choose_dtype(precision: str, device: torch.device) -> torch.dtype:
    """Return bfloat16 for ``auto`` where the processor multiplies it natively, else float32."""
    if precision == "auto":
        precision = "bf16" if has_bf16(device) else "fp32"
    return torch.bfloat16 if precision == "bf16" else torch.float32


def has_bf16(device: torch.device) -> bool:
    """Return whether products in bfloat16 are faster than in float32 there."""
    if device.type == "cuda":
        return torch.cuda.is_bf16_supported(including_emulation=False)
    capabilities = torch.cpu.get_capabilities()
    return any(bool(capabilities.get(name)) for name in ("avx512_bf16", "amx_bf16", "amx"))


def share_of_processors() -> int:
    """Return how many processors this process has for itself."""
    processes = int(os.environ.get("LOCAL_WORLD_SIZE", "1"))
    return max(1, len(os.sched_getaffinity(0)) // processes)


def use_threads(count: int) -> None:
    """Let torch use so many threads; with 0, this process's share of the processors."""
    torch.set_num_threads(count or share_of_processors())

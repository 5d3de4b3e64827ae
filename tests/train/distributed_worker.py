"""One of the processes of test_distributed.py: python -m tests.train.distributed_worker FOLDER."""

import sys
from pathlib import Path

import torch
from safetensors.torch import load_file, save_file

from tests.train.linear_quadratic import LinearQuadratic, make_learner
from unicon.train.learning.distributed import join_world
from unicon.train.learning.normalizer import moments_of
from unicon.train.learning.rollout import Batch
from unicon.train.runs.checkpoint import write_checkpoint


def gradients(learner, batch):
    """Return the gradients of a batch's loss, averaged over the processes."""
    ppo = learner.ppo
    batch = batch._replace(advantages=ppo._normalize(batch.advantages))
    ppo.gradients(batch)
    return {str(index): parameter.grad.clone() for index, parameter in enumerate(ppo.parameters)}


def main(folder):
    """Take this process's half of a batch, then train a little."""
    world = join_world(torch.device("cpu"))
    whole = Batch(**load_file(folder / "batch.safetensors"))
    half = Batch(*(tensor.chunk(world.size)[world.rank].contiguous() for tensor in whole))
    learner = make_learner(LinearQuadratic(num_envs=64, seed=world.rank), world)
    results = gradients(learner, half)
    merged = world.merge_moments(moments_of(half.observations))
    results |= {"mean": merged.mean, "variance": merged.variance, "count": merged.count[None]}
    stop = world.any([world.rank == 1, False])
    results["any"] = torch.tensor([int(flag) for flag in stop])
    for index in range(2):
        report = learner.iterate(index / 2)
    results |= {f"network.{name}": value for name, value in learner.network.state_dict().items()}
    results["samples"] = torch.tensor([report.samples])
    write_checkpoint(folder, learner, 0.0, keep=1)
    save_file({k: v.contiguous() for k, v in results.items()}, folder / f"{world.rank}.safetensors")
    world.leave()


if __name__ == "__main__":
    main(Path(sys.argv[1]))

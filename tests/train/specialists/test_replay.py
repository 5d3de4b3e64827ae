import torch

from unicon.train.specialists.replay import Lesson, Replay

CPU = torch.device("cpu")


def _lesson(first: int, count: int) -> Lesson:
    numbers = torch.arange(first, first + count, dtype=torch.float32)
    return Lesson(numbers[:, None].expand(-1, 4).clone(), numbers[:, None].expand(-1, 2).clone(), numbers)


def _all_values(replay: Replay) -> set[float]:
    return set(replay.draw(2000, torch.Generator().manual_seed(0)).values.tolist())


def test_it_never_takes_more_memory_than_it_may():
    replay = Replay(403, 35, 1.0, CPU)
    # 439 numbers of two bytes
    assert replay.capacity == 2**20 // 878
    assert 0.99 * 2**20 < replay.bytes <= 2**20
    for first in range(0, 5000, 500):
        replay.add(Lesson(torch.ones(500, 403), torch.ones(500, 35), torch.full((500,), float(first))))
    assert replay.count == replay.capacity
    assert replay.bytes <= 2**20


def test_the_oldest_samples_are_overwritten_when_it_is_full():
    replay = Replay(4, 2, 10 * 14 / 2**20, CPU)
    assert replay.capacity == 10
    replay.add(_lesson(0, 6))
    assert _all_values(replay) == set(range(6))
    replay.add(_lesson(6, 6))
    assert _all_values(replay) == set(range(2, 12))
    replay.add(_lesson(100, 25))
    assert _all_values(replay) == set(range(115, 125))


def test_the_parts_of_a_sample_stay_together():
    replay = Replay(4, 2, 10 * 14 / 2**20, CPU)
    replay.add(_lesson(3, 17))
    lesson = replay.draw(64, torch.Generator().manual_seed(1))
    assert lesson.observations.dtype == torch.float32
    assert torch.equal(lesson.observations, lesson.values[:, None].expand(-1, 4))
    assert torch.equal(lesson.actions, lesson.values[:, None].expand(-1, 2))


def test_what_half_precision_cannot_hold_stays_finite():
    replay = Replay(4, 2, 1.0, CPU)
    replay.add(Lesson(torch.full((1, 4), 1e9), torch.full((1, 2), -1e9), torch.zeros(1)))
    lesson = replay.draw(1, torch.Generator())
    assert torch.isfinite(lesson.observations).all()
    assert torch.isfinite(lesson.actions).all()

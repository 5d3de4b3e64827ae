import torch

from unicon.train.learning.compute import choose_dtype, has_bf16, share_of_processors

CPU = torch.device("cpu")


def test_auto_is_bfloat16_only_where_the_processor_has_it(monkeypatch):
    monkeypatch.setattr(torch.cpu, "get_capabilities", lambda: {"avx512_bf16": True})
    assert has_bf16(CPU)
    assert choose_dtype("auto", CPU) == torch.bfloat16
    monkeypatch.setattr(torch.cpu, "get_capabilities", lambda: {"avx2": True})
    assert choose_dtype("auto", CPU) == torch.float32
    assert choose_dtype("bf16", CPU) == torch.bfloat16


def test_processes_on_one_machine_share_its_processors(monkeypatch):
    monkeypatch.setattr("os.sched_getaffinity", lambda _: set(range(16)), raising=False)
    monkeypatch.setenv("LOCAL_WORLD_SIZE", "4")
    assert share_of_processors() == 4
    monkeypatch.setenv("LOCAL_WORLD_SIZE", "64")
    assert share_of_processors() == 1

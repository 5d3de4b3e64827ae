"""Tests for build.py."""

from __future__ import annotations

import sys

import pytest

from unicon.train.environment.batch_simulator import build
from unicon.train.environment.batch_simulator.build import NoCompilerError, build_kernel


@pytest.fixture
def empty_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("UNICON_CACHE", str(tmp_path))
    return tmp_path


def fake_compiler(folder, monkeypatch, program):
    path = folder / "compiler"
    path.write_text(f"#!{sys.executable}\nimport sys\n{program}")
    path.chmod(0o755)
    monkeypatch.setenv("CXX", str(path))


COUNTING = """
if "-o" in sys.argv:
    open(sys.argv[sys.argv.index("-o") + 1], "w").write("library")
    open(__file__ + ".calls", "a").write("x")
"""


def test_no_compiler_is_said_in_one_sentence_with_the_way_out(empty_cache, monkeypatch):
    monkeypatch.setenv("CXX", "no-such-compiler")
    with pytest.raises(NoCompilerError, match=r"no-such-compiler.*apt install g\+\+.*mujoco simulator"):
        build_kernel()


def test_a_compiler_that_fails_is_said_and_leaves_its_words(empty_cache, monkeypatch):
    fake_compiler(empty_cache, monkeypatch, 'print("it broke"); sys.exit("-o" in sys.argv)')
    with pytest.raises(NoCompilerError, match="compile.log"):
        build_kernel()
    logs = list(empty_cache.rglob("compile.log"))
    assert "it broke" in logs[0].read_text()
    assert not list(empty_cache.rglob("kernel.so"))


def test_it_is_compiled_once_until_something_changes(empty_cache, monkeypatch):
    fake_compiler(empty_cache, monkeypatch, COUNTING)
    calls = empty_cache / "compiler.calls"
    assert build_kernel() == build_kernel()
    assert calls.read_text() == "x"
    monkeypatch.setattr(build, "processor", lambda: "another processor")
    build_kernel()
    assert calls.read_text() == "xx"


def test_the_key_depends_on_header_and_flags(monkeypatch):
    keys = {
        build.build_key("g++", "header"),
        build.build_key("g++", "other header"),
        build.build_key("g++", "header", ("-O0",)),
    }
    assert len(keys) == 3


def test_a_processor_is_told_by_its_flags(tmp_path):
    cpuinfo = tmp_path / "cpuinfo"
    cpuinfo.write_text("processor : 0\nflags : sse avx\nprocessor : 1\nflags : sse avx\n")
    assert build.processor(cpuinfo).endswith("flags : sse avx")
    assert build.processor(tmp_path / "none")


def test_the_command_prints_where_the_library_is(empty_cache, monkeypatch, capsys):
    fake_compiler(empty_cache, monkeypatch, COUNTING)
    assert build.main() == 0
    assert "kernel.so" in capsys.readouterr().out
    monkeypatch.setenv("CXX", "no-such-compiler")
    assert build.main() == 2
    assert "mujoco simulator" in capsys.readouterr().err

"""Tests for unicon/doctor.py and unicon/machine_probes.py."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from rich.console import Console

from unicon import doctor
from unicon import machine_probes as probes
from unicon.doctor import DoctorConfig, Finding
from unicon.pacing import Percentiles

CONFIG = DoctorConfig(pace_s=0.05, physics_ticks=2)


def test_python_outside_the_range_is_a_failure_with_advice():
    assert doctor.examine_python((3, 11)).status == "ok"
    assert doctor.examine_python((3, 13)).status == "ok"
    for version in ((3, 10), (3, 14)):
        finding = doctor.examine_python(version)
        assert finding.status == "failure" and "make PYTHON=" in finding.advice


def test_a_missing_compiler_is_a_warning_with_what_to_type(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    finding = doctor.examine_compiler()
    assert finding.status == "warning" and "sudo apt install g++" in finding.advice


def test_one_core_is_a_warning(monkeypatch):
    monkeypatch.setattr(doctor.os, "sched_getaffinity", lambda pid: {0})
    assert doctor.examine_cores().status == "warning"


def test_free_memory_is_what_the_kernel_calls_available(tmp_path):
    meminfo = tmp_path / "meminfo"
    meminfo.write_text("MemTotal: 9 kB\nMemFree: 2 kB\nMemAvailable: 5 kB\n")
    assert probes.free_memory_bytes(meminfo) == 5 * 1024


@pytest.mark.parametrize(("free_gb", "status"), [(50, "ok"), (1, "warning"), (0.1, "failure")])
def test_a_disk_is_judged_by_what_is_free(monkeypatch, free_gb, status):
    usage = SimpleNamespace(free=free_gb * 1e9)
    monkeypatch.setattr(doctor.shutil, "disk_usage", lambda path: usage)
    assert doctor.examine_disk(CONFIG).status == status


def test_without_any_opengl_the_packages_to_install_are_named(monkeypatch):
    monkeypatch.setattr(probes, "draws_with", lambda backend: False)
    finding = doctor.examine_gl()
    assert finding.status == "warning" and "libegl1" in finding.advice


def test_the_first_opengl_that_draws_is_taken(monkeypatch):
    monkeypatch.setattr(probes, "draws_with", lambda backend: backend == "osmesa")
    assert doctor.examine_gl() == Finding("OpenGL", "ok", "draws with osmesa")


def test_a_backend_that_does_not_exist_draws_nothing():
    assert not probes.draws_with("no_such_backend")


def test_without_ros_discovery_falls_back_to_plain_udp(monkeypatch):
    monkeypatch.setattr(probes, "has_ros", lambda: False)
    finding = doctor.examine_discovery()
    assert finding.status == "ok" and "ROS is not installed" in finding.value


def test_an_address_that_is_not_this_machines_hears_nothing():
    assert not probes.hears_itself_over_udp("192.0.2.1")


def test_nodes_that_do_not_meet_are_a_failure(monkeypatch):
    monkeypatch.setattr(probes, "has_ros", lambda: True)
    monkeypatch.setattr(probes, "discovery_seconds", lambda script: None)
    assert doctor.examine_discovery().status == "failure"


def test_a_probe_that_fails_to_start_finds_nothing(tmp_path):
    script = tmp_path / "probe.py"
    script.write_text("raise SystemExit(1)")
    assert probes.discovery_seconds(script) is None


def test_the_time_is_the_one_that_the_probe_prints(tmp_path):
    script = tmp_path / "probe.py"
    script.write_text("print('0.250')")
    assert probes.discovery_seconds(script) == 0.25


@pytest.mark.ros
def test_two_nodes_meet_on_this_machine():
    pytest.importorskip("rclpy")
    assert probes.discovery_seconds(doctor.ROOT / probes.DISCOVERY_SCRIPT) is not None


def test_a_loop_that_wakes_late_is_a_warning(monkeypatch):
    monkeypatch.setattr(probes, "sleep_lateness", lambda s: Percentiles(0.001, 0.02, 0.05))
    finding = doctor.examine_pace(CONFIG)
    assert finding.status == "warning"
    assert finding.value == "late by p50 1.0, p99 20.0, max 50.0 ms"


def test_lateness_is_measured_and_ordered():
    late = probes.sleep_lateness(0.05)
    assert 0.0 <= late.p50 <= late.p99 <= late.max


@pytest.mark.parametrize(("steps_per_s", "status"), [(24_000, "ok"), (480, "warning"), (120, "failure")])
def test_physics_is_judged_against_240_steps_a_second(monkeypatch, steps_per_s, status):
    monkeypatch.setattr(probes, "physics_steps_per_s", lambda ticks: steps_per_s)
    assert doctor.examine_physics(CONFIG).status == status


def test_physics_speed_is_measured():
    assert probes.physics_steps_per_s(2) > 0.0


def test_only_a_failure_changes_the_exit_status():
    fine, warning = Finding("a", "ok", ""), Finding("b", "warning", "")
    assert doctor.exit_status([fine, warning]) == 0
    assert doctor.exit_status([fine, Finding("c", "failure", "")]) == 1


def test_the_table_prints_findings_as_they_are(monkeypatch):
    findings = [Finding("disk", "failure", "[no] markup", "make room")]
    monkeypatch.setattr(doctor, "examine", lambda: findings)
    console = Console(record=True, width=120, file=open("/dev/null", "w"))
    assert doctor.main(console) == 1
    printed = console.export_text()
    assert "[no] markup" in printed and "make room" in printed and "failure" in printed

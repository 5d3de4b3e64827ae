"""Makes this checkout ready: .venv with pinned packages, the library, and the built ROS workspace.

usage: python3 tools/setup.py [group ...]        groups: base ros train dev bench (default: base ros)

Each step is stamped with a hash of what it depends on and is left out while that stays the same, so
a second call takes a second. An interrupted step has no stamp and is done again. Standard library
only, in a syntax that old Pythons read too, to be able to say that they are too old.
"""

import ctypes
import hashlib
import importlib.util
import os
import shutil
import subprocess
import sys
import sysconfig
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
VENV = ROOT / ".venv"
STAMPS = VENV / ".unicon-stamps"
WORKSPACE = ROOT / "ros_ws"
KERNEL = ROOT / "unicon" / "train" / "environment" / "batch_simulator"
LOG = VENV / "setup.log"
GROUPS = ("base", "ros", "train", "dev", "bench")
PYTHONS = ((3, 12), (3, 11), (3, 13))
# The real program: inside an activated .venv, sys.executable is a link that a new .venv takes away.
PYTHON = os.path.realpath(getattr(sys, "_base_executable", None) or sys.executable)
FIRST_SPACE_BYTES = 3 * 10**9
APT_LINE = "sudo apt install g++ python3-dev python3-venv"
GL_PACKAGES = ("libegl1", "libgl1-mesa-dri")
BUILD_INPUTS = (
    *("package.xml", "CMakeLists.txt", "*.msg", "*.srv", "*.action"),
    *("setup.py", "setup.cfg", "*.launch.py", "*.yaml"),
)


class SetupError(Exception):
    """Something that a person has to mend; the message is one sentence that says how."""


def main(words):
    """Do all steps; return the exit status."""
    try:
        groups = choose_groups(words)
        if sys.version_info[:2] not in PYTHONS:
            change_python(words)
        check_machine()
        with_ros = has_sourced_ros()
        steps = plan(groups, with_ros)
        for number, (label, stamp, inputs, work) in enumerate(steps, 1):
            run_step("[%d/%d] %s" % (number, len(steps), label), stamp, inputs, work)
        return 0
    except SetupError as error:
        print("set-up: %s" % error, file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("\nset-up: interrupted; run it again to go on", file=sys.stderr)
        return 130


def choose_groups(words):
    """Return the requirement groups asked for."""
    if any(word in ("-h", "--help") for word in words):
        print(__doc__)
        sys.exit(0)
    unknown = [word for word in words if word not in GROUPS]
    if unknown:
        raise SetupError("there is no group %r; choose from: %s" % (unknown[0], " ".join(GROUPS)))
    return [group for group in GROUPS if group in (words or ("base", "ros"))]


def change_python(words):
    """Start again under a Python that will do; return where there is none."""
    for version in PYTHONS:
        python = shutil.which("python%d.%d" % version)
        if python and subprocess.call([python, "-c", ""], stderr=subprocess.DEVNULL) == 0:
            os.execv(python, [python, os.path.abspath(__file__)] + words)


def check_machine():
    """Refuse a machine on which set-up cannot end well."""
    if sys.version_info[:2] not in PYTHONS:
        raise SetupError(
            "this is Python %d.%d, but 3.11, 3.12 or 3.13 is needed: install one and run "
            "`make PYTHON=python3.12 ...`" % sys.version_info[:2]
        )
    if not (shutil.which("c++") or shutil.which("g++")):
        raise SetupError("there is no C++ compiler, which the messages need: run `%s`" % APT_LINE)
    if not Path(sysconfig.get_paths()["include"], "Python.h").exists():
        raise SetupError("the headers of Python are missing: run `%s`" % APT_LINE)
    if importlib.util.find_spec("venv") is None or importlib.util.find_spec("ensurepip") is None:
        raise SetupError("this Python cannot make virtual environments: run `%s`" % APT_LINE)
    free = shutil.disk_usage(str(ROOT)).free
    if not VENV.exists() and free < FIRST_SPACE_BYTES:
        raise SetupError(
            "%.1f GB of disk are free at %s, but set-up needs 3 GB: make room and run it again"
            % (free / 1e9, ROOT)
        )


def has_sourced_ros():
    """Return whether a ROS 2 Jazzy is sourced in this shell, other than the project's own."""
    distro = os.environ.get("ROS_DISTRO")
    prefixes = [Path(p) for p in os.environ.get("AMENT_PREFIX_PATH", "").split(":") if p]
    if not distro or not any(holds_ros(prefix) for prefix in prefixes):
        return False
    if distro != "jazzy":
        raise SetupError(
            "ROS 2 %s is sourced, but Jazzy is needed: source that, or none to get wheels" % distro
        )
    if importlib.util.find_spec("rclpy") is None:
        raise SetupError(
            "ROS 2 Jazzy is sourced, but %s cannot import its rclpy: run "
            "`make PYTHON=/usr/bin/python3 ...`" % PYTHON
        )
    return True


def holds_ros(prefix):
    """Return whether a prefix is an installed ROS; a .venv with the wheels is not."""
    index = prefix / "share" / "ament_index" / "resource_index" / "packages"
    return (index / "rclpy").exists() and not (prefix / "pyvenv.cfg").exists()


def plan(groups, with_ros):
    """Return the steps: label, name of the stamp, what it depends on, and the work."""
    files = [
        ROOT / "requirements" / (group + ".txt") for group in groups if not (with_ros and group == "ros")
    ]
    constraints = ROOT / "requirements" / "constraints.txt"
    python = [sys.version, PYTHON, str(VENV), str(with_ros)]
    steps = [("making .venv", "venv", python, lambda: make_venv(with_ros))]
    for path in files:
        inputs = python + [path.read_text(), constraints.read_text()]
        work = lambda path=path: install_requirements(path, constraints)  # noqa: E731
        steps.append(("installing %s packages" % path.stem, path.stem, inputs, work))
    library = python + [(ROOT / "pyproject.toml").read_text()]
    steps.append(("installing the library", "library", library, install_library))
    if has_packages():
        build = python + hash_tree(WORKSPACE / "src", BUILD_INPUTS)
        steps.append(("building the ROS workspace", "workspace", build, build_workspace))
    if "train" in groups:
        kernel = python + hash_tree(KERNEL, ("*.cpp", "*.hpp", "*.py"))
        kernel += hash_tree(ROOT / "unicon" / "humanoid", ("*.py",))
        steps.append(("compiling the batch simulator", "kernel", kernel, compile_kernel))
    steps.append(("looking for OpenGL", "gl", python, provide_gl))
    return steps


def run_step(label, stamp_name, inputs, work):
    """Do a step unless its stamp says that it is done; show how long it takes."""
    wanted = hashlib.sha256("\0".join(inputs).encode()).hexdigest()
    stamp = STAMPS / stamp_name
    if stamp.exists() and stamp.read_text() == wanted and (VENV / "bin" / "python").exists():
        return
    with Progress(label):
        note = work()
    if note:
        print("    " + note)
    STAMPS.mkdir(parents=True, exist_ok=True)
    stamp.write_text(wanted)


class Progress:
    """One line for a step, with its seconds counting where the output is a terminal."""

    def __init__(self, label):
        self.label, self.done = label, threading.Event()

    def __enter__(self):
        self.start = time.monotonic()
        if not sys.stdout.isatty():
            print(self.label, "...", flush=True)
        self.thread = threading.Thread(target=self.count, daemon=True)
        self.thread.start()

    def count(self):
        """Show the seconds until the step is over."""
        while sys.stdout.isatty() and not self.done.wait(0.5):
            print("\r%s ... %d s" % (self.label, time.monotonic() - self.start), end="", flush=True)

    def __exit__(self, kind, error, traceback):
        self.done.set()
        self.thread.join()
        seconds = time.monotonic() - self.start
        outcome = "done" if kind is None else "failed"
        lead = "\r%s ... " % self.label if sys.stdout.isatty() else "    "
        print("%s%s, %.0f s" % (lead, outcome, seconds), flush=True)


def make_venv(with_ros):
    """Make a new virtual environment; what was there before may be broken or for another place."""
    if VENV.exists():
        shutil.rmtree(str(VENV))
    arguments = ["--system-site-packages"] if with_ros else []
    run([PYTHON, "-m", "venv"] + arguments + [str(VENV)], "making .venv", log=False)
    run([str(VENV / "bin" / "python"), "-m", "pip", "--version"], "starting pip")


def install_requirements(path, constraints):
    """Install one file of requirements."""
    begun = STAMPS / (path.stem + ".begun")
    again = ["--force-reinstall"] if begun.exists() else []  # a package may have been cut in half
    begun.touch()
    arguments = ["install", "-r", str(path), "-c", str(constraints)] + again
    pip(arguments, "installing %s" % path.relative_to(ROOT))
    begun.unlink()


def install_library():
    """Install the library so that changes to it count at once."""
    pip(["install", "--no-deps", "-e", str(ROOT)], "installing the library")


def pip(arguments, what):
    """Run pip in the virtual environment."""
    quiet = ["--quiet", "--disable-pip-version-check", "--no-input"]
    run([str(VENV / "bin" / "python"), "-m", "pip"] + arguments + quiet, what)


def has_packages():
    """Return whether there are ROS packages to build."""
    return any((WORKSPACE / "src").glob("*/package.xml"))


def hash_tree(folder, patterns):
    """Return the names and contents of all files below a folder that match."""
    files = sorted({p for pattern in patterns for p in folder.resolve().rglob(pattern)})
    return ["%s\0%s" % (p.relative_to(folder.resolve()), p.read_text()) for p in files]


def build_workspace():
    """Build all ROS packages with colcon."""
    for name in ("build", "install"):
        if not (STAMPS / "workspace").exists():
            shutil.rmtree(str(WORKSPACE / name), ignore_errors=True)
    environment = dict(os.environ)
    if not has_sourced_ros():
        environment.update(AMENT_PREFIX_PATH=str(VENV), CMAKE_PREFIX_PATH=str(VENV))
    environment["PATH"] = "%s:%s" % (VENV / "bin", environment["PATH"])
    environment["VIRTUAL_ENV"] = str(VENV)
    ninja = shutil.which("ninja", path=environment["PATH"])
    cmake = ["-G", "Ninja" if ninja else "Unix Makefiles"]
    cmake += ["-DCMAKE_BUILD_TYPE=Release", "-DBUILD_TESTING=OFF"]
    cmake += ["-DPython3_EXECUTABLE=%s" % (VENV / "bin" / "python")]
    cmake += ["-DCMAKE_PROJECT_INCLUDE=%s" % (ROOT / "tools" / "ros_wheels_fixups.cmake")]
    colcon = [
        str(VENV / "bin" / "python"),
        "-m",
        "colcon",
        "build",
        "--symlink-install",
        "--cmake-args",
    ]
    run(colcon + cmake, "building the ROS workspace", cwd=WORKSPACE, env=environment)


def compile_kernel():
    """Compile the trainer's simulator; return what to say where it cannot be: training goes on without."""
    command = [str(VENV / "bin" / "python"), "-m", "unicon.train.environment.batch_simulator.build"]
    return "" if succeeds(command) else "it could not be compiled; training uses MuJoCo instead, slowly"


def provide_gl():
    """Install OpenGL for pictures where it is missing and this user may; return what to say."""
    if any(loads(name) for name in ("libEGL.so.1", "libOSMesa.so.8", "libOSMesa.so.6")):
        return ""
    line = ["apt-get", "install", "--yes", "--quiet"] + list(GL_PACKAGES)
    sudo = [] if os.geteuid() == 0 else ["sudo", "-n"]
    may = shutil.which("apt-get") and (not sudo or succeeds(sudo + ["true"]))
    if may and succeeds(sudo + ["apt-get", "update", "--quiet"]) and succeeds(sudo + line):
        return "installed %s for pictures and video" % " and ".join(GL_PACKAGES)
    return "no EGL or OSMesa: for pictures and video run `sudo apt install %s`" % " ".join(GL_PACKAGES)


def loads(library):
    """Return whether a shared library can be loaded."""
    try:
        ctypes.CDLL(library)
        return True
    except OSError:
        return False


def succeeds(command):
    """Return whether a command ends well; what it prints goes to the log."""
    with open(str(LOG), "a") as log:
        return subprocess.call(command, stdout=log, stderr=log, stdin=subprocess.DEVNULL) == 0


def run(command, what, log=True, **options):
    """Run a command, its output going to the log.

    Raises:
        SetupError: when it fails; the message says why, as far as its output tells.
    """
    options.update(stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
    try:
        result = subprocess.run(command, text=True, **options)
    except OSError as error:
        raise SetupError("%s failed: cannot run %s (%s)" % (what, command[0], error.strerror)) from error
    if log:
        with open(str(LOG), "a") as file:
            file.write("$ %s\n%s\n" % (" ".join(command), result.stdout))
    if result.returncode:
        raise SetupError(explain(what, result.stdout, log))


NETWORK_SIGNS = (
    "NewConnectionError",
    "Failed to establish a new connection",
    "Failed to resolve",
    "Temporary failure in name",
    "Network is unreachable",
    "ConnectTimeout",
    "ReadTimeout",
    "ProxyError",
    "SSLError",
)
DISK_SIGNS = ("No space left on device",)


def explain(what, output, log):
    """Return one sentence on a command that failed."""
    if any(sign in output for sign in DISK_SIGNS):
        return "%s failed for lack of disk space: make room and run it again" % what
    if any(sign in output for sign in NETWORK_SIGNS):
        advice = "check the network and run it again"
        return "%s failed since the package index cannot be reached: %s" % (what, advice)
    if "No module named colcon" in output:
        return "%s needs colcon: run `sudo apt install python3-colcon-common-extensions`" % what
    last = [line for line in output.splitlines() if line.strip()][-1:] or ["no output"]
    where = "; all of it is in %s" % LOG if log else ""
    return "%s failed (%s)%s" % (what, last[0].strip(), where)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

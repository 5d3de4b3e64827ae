"""Loads programs that are no modules: set-up and the commands in tools/bin."""

from __future__ import annotations

from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from types import ModuleType


def load_script(path: Path) -> ModuleType:
    """Import a program from its file, whatever its name ends in; its main() is not called."""
    loader = SourceFileLoader(path.stem + "_script", str(path))
    spec = spec_from_loader(loader.name, loader)
    assert spec is not None
    module = module_from_spec(spec)
    loader.exec_module(module)
    return module

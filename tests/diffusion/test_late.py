"""What torch reads late is run when a name in it is looked up, not before, and once."""

import importlib
import sys

from pipeline.diffusion import LateModule


def test_a_late_module_runs_when_a_name_in_it_is_looked_up(tmp_path, monkeypatch):
    (tmp_path / "slow_start.py").write_text("import sys\nsys.started = getattr(sys, 'started', 0) + 1\nANSWER = 42\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setitem(sys.modules, "slow_start", LateModule("slow_start"))
    monkeypatch.setattr(sys, "started", 0, raising=False)
    module = importlib.import_module("slow_start")
    assert not hasattr(module, "__wrapped__")  # `inspect` asks all modules for such
    assert sys.started == 0
    assert module.ANSWER == 42
    assert not hasattr(module, "missing")
    assert sys.started == 1

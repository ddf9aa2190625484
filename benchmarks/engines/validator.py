"""NVIDIA's USD validator (`usd-validation-nvidia`): what it finds, by rule, as `python validator.py STAGE PLAN OUT`."""

import json
import sys
from collections import Counter
from pathlib import Path

from usd_validation_nvidia import ValidationEngine

if __name__ == "__main__":
    found: Counter[str] = Counter()
    examples: dict[str, str] = {}
    engine = ValidationEngine()
    for rule in engine.initialized_rules:
        if not rule.__module__.startswith(
            "usd_validation_nvidia"
        ):  # of what else is installed: SimReady's are for an asset and its profile
            engine.disable_rule(rule)
    for issue in engine.validate(sys.argv[1]).issues():
        rule = f"{getattr(issue.severity, 'name', issue.severity)} {issue.rule.__name__ if issue.rule else '-'}"
        found[rule] += 1
        examples.setdefault(rule, f"{issue.message} {issue.at}")
    Path(sys.argv[3]).write_text(json.dumps({"issues": found, "examples": examples}))

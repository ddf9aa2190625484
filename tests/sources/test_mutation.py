"""A few of the files that `python -m tests.sources.hostile` changes by chance: each read or refused with a known reason, within the budget."""

from pipeline.sources.reasons import REASONS
from tests.sources import mutation

FILES = 45  # three of every kind


def test_changed_files_are_read_or_refused_within_the_budget(tmp_path):
    found = list(mutation.outcomes(tmp_path, range(1, FILES + 1), 2))
    assert len(found) == FILES
    for folder, kind, reasons, _, seconds, mib in found:
        assert set(reasons) <= set(REASONS) - {"internal", "reader_died"}, (folder.name, kind, reasons)
        assert seconds <= mutation.LIMIT.seconds
        assert mib <= mutation.LIMIT.mebibytes
    assert sum(many > 0 for _, _, _, many, _, _ in found) >= FILES // 3


def test_the_same_files_on_every_machine(tmp_path):
    def made(root):
        mutation.make(root, 5)
        return {p.relative_to(root): p.read_bytes() for p in root.rglob("*") if p.is_file()}

    assert made(tmp_path / "a") == made(tmp_path / "b")

"""The cache of compiled code follows all sources that are compiled into it."""

from pipeline.geometry.compiled import ROOT, source_digest


def test_the_cache_follows_every_module_that_compiles(tmp_path):
    (tmp_path / "a.py").write_text("from pipeline.geometry.compiled import compiled\n\n@compiled\ndef f(): ...\n")
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "b.py").write_text("from pipeline.geometry.compiled import borrowing\n\n@borrowing\ndef g(): ...\n")
    (tmp_path / "plain.py").write_text("x = 1\n")
    first = source_digest(tmp_path)
    (tmp_path / "plain.py").write_text("x = 2\n")
    assert source_digest(tmp_path) == first
    (tmp_path / "sub" / "b.py").write_text("from pipeline.geometry.compiled import borrowing\n\n@borrowing\ndef g(): return 1\n")
    assert source_digest(tmp_path) != first
    assert source_digest(ROOT) == source_digest(ROOT)

"""Whether homes come out the same here: what differs is named with its size, and instructions are held to what most machines have."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

sys.path.insert(0, str(Path(__file__).parent))
import papers

from pipeline.execution import pin_instructions
from pipeline.execution.machine import PINNED
from pipeline.homes.reproduction import differing, made_with, spread_indices

ROOT = Path(__file__).parents[2]


def told(folder, indices=range(10)):
    return differing(folder, papers.HEADER, papers.open_paper(folder.parent), papers.request, list(indices))


def test_what_differs_is_named_with_its_size(tmp_path):
    folder = tmp_path / "set"
    papers.made.fill(folder)
    assert told(folder) == []
    path = folder / "objects" / "shard-00001.parquet"
    data = pq.read_table(path)
    rows = data.to_pylist()
    rows[0]["latent"][3] += 2**-10
    rows[1]["category"] = "desk"
    pq.write_table(pa.Table.from_pylist(rows, schema=data.schema), path, store_schema=True)
    (folder / "usd" / "shard-00002" / "s5_00000009.usdc").write_bytes(b"?")
    assert told(folder) == [
        "s5_00000004: objects.category (1 rows), objects.latent (1 rows, by 1e-03 at most)",
        "s5_00000009: usd/shard-00002/s5_00000009.usdc",
    ]
    assert told(folder, [0, 1, 8]) == []


def test_the_homes_are_spread_over_the_dataset():
    assert spread_indices(papers.HEADER, 4) == [0, 3, 6, 9]
    assert spread_indices(papers.HEADER, 100) == list(range(10))


def test_other_versions_are_another_dataset():
    here = replace(papers.HEADER, versions=made_with())
    there = replace(here, versions={**here.versions, "torch": "1.0", "instructions": "abacus"})
    assert {line.split()[0] for line in here.differences(there)} == {"torch", "instructions"}


@pytest.mark.parametrize(("flags", "kept"), [("fpu avx avx2 avx512f", True), ("fpu avx", False), (None, False)])
def test_instructions_are_held_to_what_the_machine_has(tmp_path, monkeypatch, flags, kept):
    for name in PINNED:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("MKL_CBWR", "AVX")  # the user's word counts
    if flags:
        (tmp_path / "proc").mkdir()
        (tmp_path / "proc" / "cpuinfo").write_text(f"flags\t\t: {flags}\n")
    pin_instructions(tmp_path)
    assert os.environ.get("ATEN_CPU_CAPABILITY") == ("avx2" if kept else None)
    assert os.environ["MKL_CBWR"] == "AVX"


@pytest.mark.skipif(" avx2 " not in Path("/proc/cpuinfo").read_text(), reason="a machine without AVX2")
def test_stages_compute_with_the_same_sums_whatever_the_machine_has_besides():
    """The same net in processes that may and may not use wider instructions gives the same bits once a stage is imported."""
    program = (
        "import stages, torch; torch.manual_seed(0); torch.set_num_threads(1)\n"
        "net = torch.nn.TransformerEncoderLayer(96, 4, 256, batch_first=True).eval()\n"
        "x = net(torch.randn(6, 24, 96)); print(x.double().sum().item().hex(), torch.backends.cpu.get_cpu_capability())"
    )
    clean = {k: v for k, v in os.environ.items() if k not in PINNED}
    found = {
        subprocess.run([sys.executable, "-c", program], env={**clean, **more}, cwd=ROOT, capture_output=True, check=True, text=True).stdout
        for more in ({}, {"ONEDNN_MAX_CPU_ISA": "SSE41"}, {"OPENBLAS_CORETYPE": "Prescott"})
    }
    assert len(found) == 1
    assert next(iter(found)).endswith("AVX2\n")


@pytest.mark.skipif(" avx512f " not in Path("/proc/cpuinfo").read_text(), reason="a machine without AVX-512")
def test_arrays_come_out_the_same_with_and_without_avx_512():
    """Products by OpenBLAS and exponentials by NumPy differ between instruction sets in their last bits; not once a stage is imported."""
    program = (
        "{first}; import hashlib, numpy as np; x = np.random.default_rng(0).normal(size=(303, 303))\n"
        "print(hashlib.sha256(b''.join(f(x).tobytes() for f in (np.exp, np.tan, lambda x: x @ x))).hexdigest())"
    )
    clean = {k: v for k, v in os.environ.items() if k not in PINNED}

    def told(first, **more):
        command = [sys.executable, "-c", program.format(first=first)]
        return subprocess.run(command, env={**clean, **more}, cwd=ROOT, capture_output=True, check=True, text=True).stdout

    held = told("import stages")
    wide = told("import sys", OPENBLAS_CORETYPE="SkylakeX")
    assert held == told("import sys", **PINNED) != wide

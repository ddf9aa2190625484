"""What of this machine the process may use."""

import ctypes
import os
import sys
from pathlib import Path

# The instructions that every x86-64 machine of the last ten years has: with wider ones sums, exponentials and angles come out in other last bits.
PINNED = {
    "ATEN_CPU_CAPABILITY": "avx2",
    "MKL_CBWR": "AVX2,STRICT",  # strict: a row of a product does not depend on how many there are
    "NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL AVX512_SPR",
    "ONEDNN_MAX_CPU_ISA": "AVX2",
    "OPENBLAS_CORETYPE": "Haswell",
}
THREADS = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")


def cores(system: Path = Path("/")) -> int:
    """Return the number of cores that this process may use: its affinity and the quota of its control groups, at least 1.

    `system` is the root below which /proc and /sys lie.
    """
    here = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return max(1, min([here, *(int(quota) for quota in _quotas(system))]))


def _quotas(system: Path) -> list[float]:
    """Return the cores that each control group around this process allows (version 1 or 2 of the kernel's interface)."""
    try:
        lines = (system / "proc/self/cgroup").read_text(encoding="utf-8").splitlines()
    except OSError:
        return []
    quotas = []
    for line in lines:
        number, controllers, name = line.split(":", 2)
        if number != "0" and "cpu" not in controllers.split(","):
            continue
        mount = system / "sys/fs/cgroup" / ("" if number == "0" else "cpu")
        place = mount / name.strip("/")
        # inside a container the path may be the host's, of which only the mount itself is seen
        for group in (place, *(p for p in place.parents if p.is_relative_to(mount))):
            quotas += _quota(group)
    return quotas


def _quota(group: Path) -> list[float]:
    """Return [cores] of one control group, [] where it sets no limit."""
    for names in (("cpu.max",), ("cpu.cfs_quota_us", "cpu.cfs_period_us")):
        try:
            quota, period = " ".join((group / name).read_text(encoding="utf-8") for name in names).split()[:2]
            return [int(quota) / int(period)] if int(quota) > 0 else []
        except (OSError, ValueError):  # no such file, or "max"
            continue
    return []


def pin_instructions(system: Path = Path("/")) -> None:
    """Hold numeric libraries to PINNED where the machine has AVX2 and nobody has said otherwise; to be called before they are loaded."""
    try:
        cpuinfo = (system / "proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return
    if " avx2 " in cpuinfo.replace("\n", " "):
        for name, value in PINNED.items():
            os.environ.setdefault(name, value)


def single_thread() -> None:
    """Make numeric libraries of this process use one thread, those that are loaded already and those that come."""
    for name in THREADS:
        os.environ[name] = "1"
    torch = sys.modules.get("torch")
    if torch is not None and torch.get_num_threads() != 1:
        torch.set_num_threads(1)


def give_memory_back() -> None:
    """Give free memory back to the system, where the C library is glibc: after a peak it would keep it, and its holes grow from batch to batch."""
    if sys.platform == "linux" and (trim := getattr(ctypes.CDLL(None), "malloc_trim", None)):
        trim(0)

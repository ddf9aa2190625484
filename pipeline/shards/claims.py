"""Claims: how several commands, on several machines, share the work on one folder without a lock of the file system.

A claim is a file that only one can create; it holds the token of who did. Its owner has a file of its own that grows while it lives.
Who is gone (its file removed, its process dead, or its file unchanged for a while) has its claims taken over: the next number of the
same name, which again only one can create. Claims save work that is done twice; that what is written stays whole does not rest on them.
"""

import itertools
import json
import os
import platform
import re
import secrets
import shutil
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from pipeline.shards.disk import sync

BEAT = 5.0  # seconds between two signs of life
PATIENCE = 60.0  # seconds without one after which an owner on another machine counts as gone
OWNERS = "owners"
RELEASED = "released"


class Claims:
    """The claims of one command on the names of a folder."""

    def __init__(self, folder: Path, *, beat: float = BEAT, patience: float = PATIENCE) -> None:
        self.folder, self.token, self.patience = folder, secrets.token_hex(8), patience
        self._seen: dict[str, tuple[int, float]] = {}  # size of an owner's file or a claim, and since when it is that
        self._ended = threading.Event()
        self._register()
        threading.Thread(target=self._live, args=(beat,), daemon=True).start()

    def take(self, name: str, *, by_force: bool = False) -> bool:
        """Claim a name; False where another has it who lives (`by_force`: who does not own it now)."""
        for number in itertools.count():
            path = self.folder / f"{name}.{number}"
            try:
                _create(path, self.token)
            except FileExistsError:
                holder = _read(path)
                if holder == self.token and not (self.folder / f"{name}.{number + 1}").exists():
                    return True
                if holder != self.token and not by_force and self._lives(holder, path):
                    return False
            else:
                return True
        raise AssertionError

    @contextmanager
    def alone(self, name: str) -> Iterator[None]:
        """Hold a name for a moment; waits for others who do."""
        while not self.take(name):
            time.sleep(0.05)
        if not (self.folder / OWNERS / self.token).exists():  # swept away by who left last, just now
            self._register()
        try:
            yield
        finally:
            for path in self.folder.glob(f"{name}.*"):
                if _read(path) == self.token:
                    with suppress(FileNotFoundError), path.open("r+") as file:  # never made anew: who left last may be sweeping
                        file.truncate(0)
                        file.write(RELEASED)

    def others(self) -> list[str]:
        """Return the tokens of the others who are at work."""
        tokens = [p.name for p in (self.folder / OWNERS).glob("*") if p.name != self.token]
        return [token for token in tokens if self._lives(token, None)]

    def forget(self, name: str) -> None:
        """Remove the claims below a name: what they were about is done."""
        shutil.rmtree(self.folder / name, ignore_errors=True)

    def leave(self, tidy: Callable[[], object] = lambda: None) -> bool:
        """Give up all claims; True when nobody else was at work: then `tidy` was called, and nothing of anyone is left here.

        Who joins meanwhile waits for the end of that, since the owner's file goes last.
        """
        self._ended.set()
        try:
            with self.alone("open"):
                if last := not self.others():
                    tidy()
                    shutil.rmtree(self.folder, ignore_errors=True)
                (self.folder / OWNERS / self.token).unlink(missing_ok=True)
        except OSError:  # a full disk: who ends cannot stay for that
            return False
        finally:  # interrupted too: a process that goes on is not at work any more
            (self.folder / OWNERS / self.token).unlink(missing_ok=True)
        return last

    def _register(self) -> None:
        who = {"machine": _machine(), "pid": os.getpid(), "born": _birth(os.getpid())}
        path = self.folder / OWNERS / self.token
        try:
            while not path.exists():
                path.parent.mkdir(parents=True, exist_ok=True)
                with suppress(FileNotFoundError):  # who left last sweeps the folder away, just now
                    path.write_text(json.dumps(who) + "\n")
                    sync(path)
        except BaseException:  # nobody will leave for it
            path.unlink(missing_ok=True)
            raise

    def _live(self, beat: float) -> None:
        while not self._ended.wait(beat):
            try:
                with (self.folder / OWNERS / self.token).open("r+") as file:  # never made anew: who is swept away is gone
                    file.seek(0, os.SEEK_END)
                    file.write(".")
            except OSError:
                continue

    def _lives(self, token: str, claim: Path | None) -> bool:
        """Tell whether the owner of a token is at work; a claim without one yet is judged by its age."""
        if token == RELEASED or (not token and not self.others()):
            return False
        path = self.folder / OWNERS / token if token else claim
        try:
            assert path is not None
            text = path.read_text(errors="replace")
        except OSError:
            return False
        if token and _owner_died(text):
            return False
        now = time.monotonic()
        size, since = self._seen.get(str(path), (-1, now))
        if size != len(text):
            self._seen[str(path)] = (len(text), since := now)
        return now - since < self.patience


def _create(path: Path, text: str) -> None:
    """Create a file that nobody has. Raises FileExistsError."""
    while True:
        try:
            descriptor = os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o644)
        except FileNotFoundError:  # the folder is not there yet, or was swept away
            path.parent.mkdir(parents=True, exist_ok=True)
            continue
        try:
            os.write(descriptor, text.encode())
        finally:
            os.close(descriptor)
        return


def _read(path: Path) -> str:
    """Return the token in a claim; "" where it is not signed yet, or a power cut has torn it."""
    try:
        text = path.read_text(errors="replace")
    except FileNotFoundError:
        return RELEASED
    return text if re.fullmatch(f"[0-9a-f]{{16}}|{RELEASED}", text) else ""


def _machine() -> dict[str, str]:
    """Return the names of this machine, of its kernel's boot and of the table of processes that this one can see; "" for what is not told."""
    told = {"host": platform.node(), "boot": "", "processes": ""}
    with suppress(OSError):
        told["host"] += Path("/etc/machine-id").read_text().strip()
    with suppress(OSError):
        told["boot"] = Path("/proc/sys/kernel/random/boot_id").read_text().strip()
    with suppress(OSError):
        told["processes"] = str(Path("/proc/self/ns/pid").readlink())
    return told


def _birth(pid: int) -> str:
    """Return when a process was born, in the kernel's count; "" where that is not told, "gone" for a process that is not there."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except FileNotFoundError:
        return "gone" if Path("/proc/self/stat").exists() else ""
    except OSError:
        return ""
    return "gone" if fields[0] in "ZX" else fields[19]


def _owner_died(text: str) -> bool:
    """Tell whether an owner was a process of this machine that is no more, or the machine has been started again; what cannot be known is no."""
    try:
        who, here = json.loads(text.splitlines()[0]), _machine()
        if who["machine"] != here:
            return bool(who["machine"]["host"] == here["host"] and who["machine"]["boot"] != here["boot"])
        os.kill(who["pid"], 0)
    except ProcessLookupError:
        return True
    except (ValueError, LookupError, TypeError):  # torn by a power cut; or being written, by who has no claims yet
        return True
    except OSError:  # not ours to signal
        return False
    return bool(_birth(who["pid"]) != who["born"])

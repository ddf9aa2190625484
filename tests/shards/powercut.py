"""A disk that is honest about fsync: it records what a program does to a folder, and replays what a power cut at any moment may leave.

What may be left: of each file the bytes that were flushed; of bytes that were not, all, some, none, or zeros. Of names (made, moved, linked,
removed) those that were flushed with their folder; of the others either a prefix in their order, as journals keep it, or any of them, as
POSIX allows; a move is then there as a whole, or the old name stays beside the new one.
"""

import contextlib
import os
import random
import shutil
import threading
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Recorder:
    """What was done below `root`, in order. Files are followed by number, whatever their names."""

    root: Path
    events: list = field(default_factory=list)
    nodes: dict = field(default_factory=dict)  # number of each path
    stamps: dict = field(default_factory=dict)  # (time, size) of each file, by number
    lock: threading.RLock = field(default_factory=threading.RLock)

    def __post_init__(self):
        self.nodes[self.root] = 0
        self.count = 1

    def mark(self, what):
        """Note that something is promised from here on."""
        with self.lock:
            self.look()
            self.events.append(("mark", what))

    def look(self):
        """Note files that were made or written since the last look."""
        for place, _, files in os.walk(self.root):
            for name in files:
                path = Path(place, name)
                with contextlib.suppress(FileNotFoundError):
                    stat = path.stat()
                    if path not in self.nodes:
                        self.made(path, folder=False)
                    if self.stamps.get(self.nodes[path]) != (stat.st_mtime_ns, stat.st_size):
                        self.stamps[self.nodes[path]] = (stat.st_mtime_ns, stat.st_size)
                        self.events.append(("data", self.nodes[path], path.read_bytes()))

    def made(self, path, *, folder):
        self.nodes[path] = self.count
        self.events.append(("make", self.nodes[path.parent], path.name, self.count, folder))
        self.count += 1

    def moved(self, source, target):
        node = self.nodes[source]
        self.events.append(("move", self.nodes[source.parent], source.name, self.nodes[target.parent], target.name, node))
        for path in [p for p in self.nodes if p == source or source in p.parents]:
            self.nodes[target / path.relative_to(source)] = self.nodes.pop(path)

    @contextlib.contextmanager
    def at_work(self):
        """Record what this process does through `os`; what writes by other ways is seen at the next step."""
        real = {name: getattr(os, name) for name in ("mkdir", "rename", "replace", "link", "unlink", "rmdir", "fsync")}

        def resolved(path, dir_fd):
            place = Path(f"/proc/self/fd/{dir_fd}").readlink() if dir_fd is not None else Path.cwd()
            return place / path

        def recorded(name, note):
            def call(*paths, **how):
                with self.lock:
                    self.look()
                    named = paths[: 2 if name in {"rename", "replace", "link"} else 1]
                    full = [Path(f"/proc/self/fd/{p}").readlink() if name == "fsync" else resolved(p, how.get("dir_fd")) for p in named]
                    answer = real[name](*paths, **how)
                    if self.root in [*full[-1].parents, full[-1]]:
                        note(*full)
                    return answer

            return call

        def linked(source, target):
            if source in self.nodes:  # or else it comes from outside, and is seen as a file of its own that is flushed before it is named
                self.nodes[target] = self.nodes[source]
                self.events.append(("link", self.nodes[target.parent], target.name, self.nodes[source]))

        def removed(path):
            self.events.append(("remove", self.nodes[path.parent], path.name))
            del self.nodes[path]

        notes = {
            "mkdir": lambda path, *_: self.made(path, folder=True),
            "rename": self.moved,
            "replace": self.moved,
            "link": linked,
            "unlink": removed,
            "rmdir": removed,
            "fsync": lambda path: self.events.append(("sync", self.nodes[path])),
        }
        try:
            for name, note in notes.items():
                setattr(os, name, recorded(name, note))
            yield self
            self.look()
        finally:
            for name, function in real.items():
                setattr(os, name, function)


def crash(events, rng):
    """Return what a power cut after some of the events may leave: bytes (or None for a folder) by relative path, and what was promised."""
    done = events[: rng.randint(0, len(events)) if rng.random() < 0.9 else len(events)]
    ordered, share = rng.random() < 0.5, rng.choice((0.0, 0.2, 0.5, 0.8, 1.0))
    pending, forced, data, safe, promised = [], set(), {}, {}, []
    for event in done:
        kind = event[0]
        if kind == "mark":
            promised.append(event[1])
        elif kind == "data":
            data[event[1]] = event[2]
        elif kind != "sync":
            pending.append(event)
        else:
            if event[1] in data:
                safe[event[1]] = data[event[1]]
            for i, names in enumerate(pending):
                if ordered or event[1] in (names[1], names[3] if names[0] == "move" else None):
                    forced.add((i, names[1] == event[1] or ordered))
    cut = rng.randint(0, len(pending))
    kept = {i for i in range(len(pending)) if (i < cut if ordered else rng.random() < share)} | {i for i, _ in forced}
    left = {i for i in range(len(pending)) if (i, True) not in forced and not ordered and rng.random() < 0.3}  # moves whose old name stays
    folders = {event[3] for event in pending if event[0] == "make" and event[4]}
    return tree([(e, i in left) for i, e in enumerate(pending) if i in kept], folders, contents(data, safe, rng)), promised


def contents(data, safe, rng):
    """Return what is left of each file's bytes."""
    whole = rng.random() < 0.3
    found = {}
    for node, written in data.items():
        ways = (written, b"", written[: len(written) // 2], bytes(len(written)), safe.get(node, b""))
        found[node] = written if whole or safe.get(node) == written else rng.choice(ways)
    return found


def tree(names, numbers, data):
    """Return the files and folders that these names make; `numbers` are those of folders."""
    folders = {0: {}, **{number: {} for number in numbers}}
    for (kind, *what), stays in names:
        if kind == "make":
            folders[what[0]][what[1]] = what[2]
        elif kind == "link":
            place, name, node = what
            folders[place][name] = node
        elif kind == "remove":
            folders[what[0]].pop(what[1], None)
        else:
            before, old, place, name, node = what
            if not stays:
                folders[before].pop(old, None)
            folders[place][name] = node
    made = {}

    def walk(node, path):
        for name, inner in folders[node].items():
            if inner in folders:
                made[path + name] = None
                walk(inner, f"{path}{name}/")
            else:
                made[path + name] = data.get(inner, b"")

    walk(0, "")
    return made


def put(state, folder):
    """Make a folder hold exactly that."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for path, data in state.items():
        if data is None:
            (folder / path).mkdir(parents=True, exist_ok=True)
        else:
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(data)


def states(events, count, seed=0):
    """Yield (state, what was promised) of so many power cuts."""
    rng = random.Random(seed)
    for _ in range(count):
        yield crash(events, rng)

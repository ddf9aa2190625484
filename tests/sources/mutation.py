"""Good files of every kind that is read, changed by chance as disks, downloads and ill will change them, and read within a budget."""

import functools
import io
import json
import re
import shutil
import struct
import time
from pathlib import Path

import numpy as np
import trimesh  # noqa: F401 - to load it is no part of what a file costs

from pipeline.sources.atiss.files import BOXES, STATS
from pipeline.sources.atiss.labels import KINDS
from pipeline.sources.batch import Batch, each
from pipeline.sources.budget import MIB, Budget
from tests.sources import collada, making
from tests.sources.reading import read
from tests.sources.test_scene_file import glb

LIMIT = Budget(seconds=2.0, mebibytes=256)
NUMBERS = (b"nan", b"-1", b"0", b"1e308", b"-1e400", b"4294967295", b"99999999999999999999", b"1e-320", b"2147483648", b"0x7f")
NUMBER = re.compile(rb"-?\d+(\.\d+)?([eE][+-]?\d+)?")
NESTS = ((b"[", b"]"), (b'{"a":', b"}"), (b"<a>", b"</a>"), (b"<node>", b"</node>"))
LARGEST = 4 * MIB  # that a change makes of a file
STL = b"\0" * 80 + struct.pack("<I", 12) + b"".join(
    struct.pack("<12fH", 0, 0, 0, *collada.corners((0.6, 0.5, 0.9))[list(face)].ravel(), 0) for face in collada.TRIANGLES
)  # fmt: skip
URDF = '<robot name="r"><link name="a"><visual><geometry><mesh filename="body.{}"/></geometry></visual></link></robot>'


def _house(root, data=None):
    making.write_library(root / "front", (making.BED,))
    return making.write_house(root / "front", making.two_rooms())


def _model(root, name):
    making.write_library(root / "front", (making.BED,))
    return root / "front" / "3D-FUTURE-model" / making.BED / name


def _object(root, name, **more):
    return making.write_partnet(root / "partnet", **more) / name


def _mesh(root, suffix, data):
    (root / "partnet").mkdir(parents=True)
    (root / "partnet" / "cabinet.urdf").write_text(URDF.format(suffix))
    (root / "partnet" / "wood.png").write_bytes(making.png())
    path = root / "partnet" / f"body.{suffix}"
    path.write_bytes(data)
    return path


def _room(root):
    kind, folder = KINDS["bedroom"], root / "peers" / "bedroom" / "a_Bedroom-1"
    folder.mkdir(parents=True)
    (folder.parent / STATS).write_text(json.dumps({"class_labels": [*kind.classes, "start", "end"]}))
    count, out = 3, io.BytesIO()
    arrays = {name: np.zeros((count, 3)) for name in ("translations", "sizes")}
    arrays["sizes"] += 0.5
    labels = np.zeros((count, len(kind.classes) + 2))
    labels[:, kind.classes.index("nightstand")] = 1
    floor = np.array([[-3, 0, -3], [3, 0, -3], [3, 0, 3], [-3, 0, 3]], float)
    texts = {"scene_id": "Bedroom-1", "scene_uid": "a_Bedroom-1", "scene_type": "bedroom", "json_path": "a"}
    np.savez_compressed(
        out, uids=np.array(["1", "2", "3"]), jids=np.array(["j", "k", "l"]), **texts, room_layout=np.zeros((64, 64, 1), np.uint8),
        floor_plan_vertices=floor, floor_plan_faces=np.array([[0, 2, 1], [0, 3, 2]]), floor_plan_centroid=np.zeros(3),
        class_labels=labels, **arrays, angles=np.zeros((count, 1)),
    )  # fmt: skip
    (folder / BOXES).write_bytes(out.getvalue())
    return folder / BOXES


MAKERS = {  # what is changed -> how a folder is made that holds it; returns its path
    "house": _house,
    "raw_model.obj": lambda root: _model(root, "raw_model.obj"),
    "model.mtl": lambda root: _model(root, "model.mtl"),
    "texture.png": lambda root: _model(root, "texture.png"),
    "gapartnet.urdf": lambda root: _object(root, "mobility_annotation_gapartnet.urdf"),
    "mobility.urdf": lambda root: _object(root, "mobility.urdf", gapartnet=False),
    "annotation.json": lambda root: _object(root, "link_annotation_gapartnet.json"),
    "meta.json": lambda root: _object(root, "meta.json"),
    "semantics.txt": lambda root: _object(root, "semantics.txt"),
    "door.obj": lambda root: _object(root, "textured_objs/door.obj"),
    "body.dae": lambda root: _mesh(root, "dae", collada.dae(size=(0.6, 0.5, 0.9), diffuse=collada.TEXTURE)),
    "body.glb": lambda root: _mesh(root, "glb", glb(image=making.png())),
    "body.stl": lambda root: _mesh(root, "stl", STL),
    "body.obj": lambda root: _mesh(root, "obj", making.box_obj((0.6, 0.5, 0.9)).encode()),
    "boxes.npz": _room,
}


def _flipped(data, rng):
    found = bytearray(data)
    for k in rng.integers(len(data), size=int(rng.integers(1, 9))):
        found[k] ^= 1 << int(rng.integers(8))
    return bytes(found)


def _renumbered(data, rng):
    spots = [m.span() for m in NUMBER.finditer(data)]
    for k in sorted({int(k) for k in rng.integers(len(spots), size=int(rng.integers(1, 4)))}, reverse=True) if spots else ():
        start, end = spots[k]
        data = data[:start] + NUMBERS[int(rng.integers(len(NUMBERS)))] + data[end:]
    return data


def _slice(data, rng):
    start = int(rng.integers(len(data)))
    return start, min(len(data), start + int(rng.integers(1, 200)))


def _cut(data, rng):
    start, end = _slice(data, rng)
    return data[:start] + data[end:]


def _moved(data, rng):
    (a, b), at = _slice(data, rng), int(rng.integers(len(data)))
    return data[:at] + data[a:b] + data[at:]


def _repeated(data, rng):
    """The same words again and again; of text often whole lines or elements."""
    a, b = _slice(data, rng)
    whole = [m.span() for m in re.finditer(rb"(?m)^.*\n|<[^<>]+/>|\{[^{}]*\},?", data)]
    if whole and rng.random() < 0.7:
        a, b = whole[int(rng.integers(len(whole)))]
    times = int(min(10 ** rng.uniform(1, 6), LARGEST / (b - a)))
    return data[:b] + data[a:b] * times + data[b:]


def _nested(data, rng):
    left, right = NESTS[int(rng.integers(len(NESTS)))]
    at, times = int(rng.integers(len(data))), int(10 ** rng.uniform(1, 5))
    return data[:at] + left * times + right * times + data[at:]


CHANGES = (_flipped, _renumbered, _cut, _moved, _repeated, _nested, lambda data, rng: data[: int(rng.integers(len(data)))])


def _chunked(data, rng):
    """Change the JSON of a .glb and say the right lengths, so that more is read than its head."""
    size = struct.unpack_from("<I", data, 12)[0]
    text = _changed(data[20 : 20 + size], rng)
    text += b" " * (-len(text) % 4)
    return (
        struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(data) - 20 - size)
        + struct.pack("<I4s", len(text), b"JSON")
        + text
        + data[20 + size :]
    )


def _changed(data, rng):
    for _ in range(int(rng.integers(1, 4))):
        data = CHANGES[int(rng.integers(len(CHANGES)))](data, rng) or b" "
    return data


def make(root, number):
    """Write folder `number` below root, one file of it changed; every fiftieth is left as it is. Return (folder, what was changed)."""
    kind = sorted(MAKERS)[number % len(MAKERS)]
    rng = np.random.default_rng((13, number))
    folder = Path(root) / f"{number:05d}"
    path = MAKERS[kind](folder)
    if number % 50 == 0:
        return folder, ""
    data = path.read_bytes()
    path.write_bytes((_chunked if kind == "body.glb" and rng.random() < 0.7 else _changed)(data, rng))
    return folder, kind


@functools.cache
def _warm():
    """Load what the first reading of a process loads."""
    import tempfile

    with tempfile.TemporaryDirectory() as place:
        for number, kind in enumerate(sorted(MAKERS)):
            MAKERS[kind](Path(place) / str(number))
            _read(Path(place) / str(number))


def _read(folder):
    """Return the rejects of all that lies in a folder, and how many assets and houses were read."""
    made = read(folder)
    return made.rejects, len(made.assets) + len(made.scenes)


def peak():
    """Return the largest memory of this process since it was last set back [bytes]."""
    line = next(t for t in Path("/proc/self/status").read_text().splitlines() if t.startswith("VmHWM:"))
    return int(line.split()[1]) * 1024


def step(warm, item):
    """Return (folder, what was changed, reasons, things read, CPU seconds, MiB beyond what the process had before)."""
    if warm:
        _warm()
    folder, kind = item
    Path("/proc/self/clear_refs").write_text("5")  # sets the peak back
    before, start = peak(), time.process_time()
    rejects, count = _read(folder)
    spent = time.process_time() - start
    shutil.rmtree(folder)
    return folder, kind, sorted({row["reason"] for row in rejects}), count, spent, (peak() - before) / MIB


def refused(item, reason, _detail):
    """What stands for a file that used up its budget."""
    return *item, [reason], 0, LIMIT.seconds, float(LIMIT.mebibytes)


def outcomes(root, numbers, workers, budget=LIMIT):
    """Yield what `step` returns of each of those folders, made below root and read in the pool of the pipeline."""
    list(each(Batch("file", step, True, [make(root, 0)], refused), 1, Budget()))  # compiles what is compiled once a machine
    items = [make(root, number) for number in numbers]
    yield from each(Batch("file", step, False, items, refused), workers, budget)

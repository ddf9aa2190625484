"""Where the objects of an articulated source lie: folders of PartNet-Mobility or GAPartNet, and URDFs by themselves."""

import os
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from pipeline.manifest import sha256
from pipeline.sources.articulated.partnet import URDFS

DEPTH = 4  # folders below the root in which objects are looked for


@dataclass(frozen=True, slots=True)
class Found:
    """An object of an articulated source: its folder or URDF relative to the source, and the stem of its assets' ids."""

    path: str
    stem: str

    @property
    def source_id(self) -> str:
        """Return the id in the source: the folder's name, or the URDF's without its suffix."""
        return self.path.rsplit("/", 1)[-1].removesuffix(".urdf")


def objects_in(source: Path) -> list[Found]:
    """Return the objects below `source`, sorted: folders of PartNet-Mobility or GAPartNet, and URDFs by themselves.

    A link to a folder elsewhere is among them, to be refused; one to a folder within would only name it twice.
    """
    root, names = source.resolve(), {name for name, _ in URDFS}
    paths = []
    for base, folders, files in os.walk(root):
        folders.sort()
        here = Path(base).relative_to(root)
        links = [f for f in folders if (Path(base) / f).is_symlink() and not (Path(base) / f).resolve().is_relative_to(root)]
        paths += [(here / link).as_posix() for link in links]
        if names & set(files) or "meta.json" in files:
            paths.append(here.as_posix())
            folders.clear()
            continue
        paths += [(here / file).as_posix() for file in sorted(files) if file.lower().endswith(".urdf")]
        if len(here.parts) >= DEPTH:
            folders.clear()
    return _stems(paths)


def _stems(paths: list[str]) -> list[Found]:
    """Give each object a stem for ids; those that share one once written in [a-z0-9_] get a digest of their path behind it."""
    plain = ["".join(c if c.isalnum() and c.isascii() else "_" for c in Found(path, "").source_id.lower())[:60] for path in paths]
    count = Counter(plain)
    return [
        Found(path, stem if count[stem] == 1 and stem.strip("_") else f"{stem.strip('_')}_{sha256(path.encode())[:8]}".strip("_"))
        for path, stem in zip(paths, plain, strict=True)
    ]

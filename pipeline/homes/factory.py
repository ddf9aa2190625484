"""The factory: requests in, homes with certificates, rows and files out; the same for every command that asks.

A home is a function of (program, seed, index, weights).
"""

import functools
import gc
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from pipeline import params, tables
from pipeline.arrange import LearntRelations, PostoptSettings
from pipeline.diffusion.checkpoint import require_vocabulary
from pipeline.diffusion.sampling import Sampler
from pipeline.diffusion.settings import SampleSettings
from pipeline.errors import ContentError, RefusedError
from pipeline.execution import give_memory_back, tell
from pipeline.floorplan.program.priors import PriorSettings
from pipeline.homes.asset_cache import AssetCache
from pipeline.homes.furnish import draft_rooms
from pipeline.homes.library import MEMORY, Library, kept_within
from pipeline.homes.life import Empty, Outcome, make_homes
from pipeline.homes.planning import PlannedHome, plan_home
from pipeline.homes.request import Request
from pipeline.homes.resources import Resources, ShardSettings
from pipeline.manifest import digest, sha256_file
from pipeline.relations.model import Relations
from pipeline.retrieval.index import AssetIndex, RetrievalSettings
from pipeline.shards import code_digest
from pipeline.verify import VerifySettings
from schemas import LATENTS

OWN = Path(__file__).resolve().parents[2]  # the checkout that this code lies in


class Factory(Resources):
    """What is loaded, and what it makes."""

    @property
    def chunk(self) -> int:
        """Homes that are sampled together."""
        return self.shard.chunk

    def first_drafts(self, requests: Sequence[Request]) -> list[PlannedHome]:
        """Return the first attempt at each home that can be: what the stage `sample` writes."""
        planned = []
        for request in requests:
            tell("planning", request.index)
            with suppress(RefusedError):  # said where the home would be made
                planned.append(plan_home(self, request, 0))
        drafts = iter(draft_rooms(self, [job for home in planned for job in home.jobs]))
        return [replace(home, drafts=tuple(next(drafts) for _ in home.jobs)) for home in planned]

    def make(self, requests: Sequence[Request], first: Sequence[PlannedHome] | None = None, *, files: bool = True) -> list[Outcome | Empty]:
        """Make a batch of homes, each an Outcome or, where it cannot be made, an Empty. `first` are first drafts that a stage has made already."""
        with _tidied_once():
            return make_homes(self, requests, {d.request.index: d for d in first or ()}, files=files)

    @functools.cached_property
    def asset_cache(self) -> AssetCache:
        """Return the asset cache of this machine from which datasets take their assets."""
        return AssetCache(self.library)


def load_factory(root: Path, tree: Mapping[str, Any], seed: int) -> Factory:
    """Load models, tables and settings of the checkout at `root`. Raises ContentError for what is missing or broken."""
    data, weights = root / "data", root / "models" / "denoiser.safetensors"
    relations = data / "tables" / "relations.json"
    if not weights.is_file():
        raise ContentError(f"there are no trained weights ({weights} is missing)", f"type `make run` in {root}")
    sampler = Sampler.load(weights, params.section(SampleSettings, tree, "sample"), seed)
    require_vocabulary(weights, sampler.header)
    library = Library.read(data / "tables", data / "assets")
    latents_file = data / "latents" / "latents.parquet"
    latents = tables.read(latents_file, LATENTS)
    index = AssetIndex.from_tables(library.rows.values(), latents, library.joints, params.section(RetrievalSettings, tree, "retrieval"))
    names = ("sample", "retrieval", "postopt", "verify", "prior", "shard")
    return Factory(
        seed,
        replace(sampler, library=index),
        index,
        library,
        params.section(ShardSettings, tree, "shard"),
        params.section(PostoptSettings, tree, "postopt"),
        params.section(VerifySettings, tree, "verify"),
        params.section(PriorSettings, tree, "prior"),
        {
            "code": code_digest(root),
            "latents": sha256_file(latents_file),
            "library": library.digest(),
            "params": digest({name: {k: v for k, v in tree[name].items() if k != "preview"} for name in names}),
            "relations": sha256_file(relations),
            "weights": sha256_file(weights),
        },
        LearntRelations(Relations.load(relations)),
    )


def open_factory(root: Path, seed: int, memory: int = MEMORY, preview: int | None = None) -> Factory:
    """Return this process's factory for the checkout at `root`, loaded once; as much of the library stays read as fits into `memory` [MiB].

    A worker on a machine that has no such folder takes the checkout that its own code lies in; the recipe's digests tell whether it is the
    same. `preview` [px] takes the place of `shard.preview` in params.yaml; a dataset's header tells it.
    """
    factory = _loaded_factory(root if (root / "params.yaml").is_file() else OWN, seed, preview)
    factory.library.kept = kept_within(memory)
    return factory


def forget_factory() -> None:
    """Let this process load its factory again when it is next opened: files have changed."""
    _loaded_factory.cache_clear()


@contextmanager
def _tidied_once() -> Iterator[None]:
    """Look for garbage at the end of the block alone, and only among what the block has made: a home hardly leaves cycles, and looking costs 1 % of its time."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        gc.collect()
        gc.freeze()
        give_memory_back()
        if enabled:
            gc.enable()


@functools.lru_cache(maxsize=1)
def _loaded_factory(root: Path, seed: int, preview: int | None) -> Factory:
    tree = params.read(root / "params.yaml")
    if preview is not None:
        tree["shard"]["preview"] = preview
    factory = load_factory(root, tree, seed)
    gc.freeze()  # modules, models and library stay: looking through them for garbage again and again costs a tenth of all time
    return factory

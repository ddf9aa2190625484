"""A dataset on disk: header, shards that are written whole or not at all, commits, checks, and what each home is asked to be."""

from pipeline.shards.address import Address
from pipeline.shards.dataset import Dataset, add_part, commit_shard, forget_altered, is_committed, open_or_create
from pipeline.shards.header import Header, code_digest, read_header
from pipeline.shards.layout import EMPTY, TABLES, scene_id, shard_name
from pipeline.shards.library import AssetSource
from pipeline.shards.mix import Mix, read_entries, read_mix, require_prompt
from pipeline.shards.parts import HomeContent, gather
from pipeline.shards.seal import identity, vouches

__all__ = [
    "EMPTY",
    "TABLES",
    "Address",
    "AssetSource",
    "Dataset",
    "Header",
    "HomeContent",
    "Mix",
    "add_part",
    "code_digest",
    "commit_shard",
    "forget_altered",
    "gather",
    "identity",
    "is_committed",
    "open_or_create",
    "read_entries",
    "read_header",
    "read_mix",
    "require_prompt",
    "scene_id",
    "shard_name",
    "vouches",
]

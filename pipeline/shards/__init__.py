"""A dataset on disk: header, shards that are written whole or not at all, commits, checks, and what each home is asked to be."""

from pipeline.shards.check import Summary, check
from pipeline.shards.content import ShardContent, gather
from pipeline.shards.dataset import Dataset, commit_library, commit_shard, committed, open_or_create
from pipeline.shards.header import Header, code_digest, read_header
from pipeline.shards.layout import TABLES, file_path, scene_id, shard_name
from pipeline.shards.mix import Mix, read_mix, require_prompt

__all__ = [
    "TABLES",
    "Dataset",
    "Header",
    "Mix",
    "ShardContent",
    "Summary",
    "check",
    "code_digest",
    "commit_library",
    "commit_shard",
    "committed",
    "file_path",
    "gather",
    "open_or_create",
    "read_header",
    "read_mix",
    "require_prompt",
    "scene_id",
    "shard_name",
]

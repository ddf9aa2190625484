"""Where things lie in a dataset folder, and the names that never last: parts, claims and staging.

dataset.json                      what the dataset is
scenes/shard-00000.parquet ...    one folder per table
usd/shard-00000/...               one folder per family of files: usd, plans, previews ...
assets/...                        the asset library that every shard reads
commits/shard-00000.json          digest of every file of the shard; written last, it makes the shard exist
commits/assets.json               the same for the library
.parts/shard-00000/00000016/      home 16 of a shard that is not whole yet; gone when it is
.claims/                          who is making what; gone when nobody is
.staging/<token>/                 what a command is writing
"""

from schemas import JOINTS, OBJECTS, OPENINGS, REJECTS, ROOMS, SCENES

TABLES = {table.name: table for table in (SCENES, ROOMS, OPENINGS, OBJECTS, JOINTS, REJECTS)}
HEADER = "dataset.json"
COMMITS = "commits"
ASSETS = "assets"
STAGING = ".staging"
PARTS = ".parts"
CLAIMS = ".claims"
EMPTY = "index"  # `what` of the rejects row of a home that could not be made: its index stays empty
PASSING = frozenset({STAGING, PARTS, CLAIMS})  # folders that are gone when a dataset is whole


def shard_name(number: int) -> str:
    """Return the name that every file and folder of shard `number` carries."""
    return f"shard-{number:05d}"


def scene_id(seed: int, index: int) -> str:
    """Return the id of home `index` of a dataset made with `seed`; it is a valid USD name."""
    return f"s{seed}_{index:08d}"


def index_of(scene: str) -> int:
    """Return the index in a scene id."""
    return int(scene.rpartition("_")[2])


def table_path(table: str, number: int) -> str:
    """Return where shard `number` of a table lies, relative to the dataset."""
    return f"{table}/{shard_name(number)}.parquet"


def commit_path(name: str) -> str:
    """Return where the commit file of a shard, or of the library (`assets`), lies."""
    return f"{COMMITS}/{name}.json"

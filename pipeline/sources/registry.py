"""The datasets that can be read, and which of them lie in a folder."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from pipeline import params
from pipeline.errors import ContentError, UsageError
from pipeline.sources.articulated.source import Articulated
from pipeline.sources.atiss.source import Atiss
from pipeline.sources.settings import PreprocessSettings
from pipeline.sources.source import Listing, Source
from pipeline.sources.threed_front.source import ThreedFront

# Models and houses are read in this order.
SOURCES: Sequence[Source] = (ThreedFront(), Articulated(), Atiss())


def configured_sources(paths: Mapping[str, str | None]) -> list[tuple[Source, str]]:
    """Return the sources that have a path. Raises ContentError for a key that is none of a source."""
    keys = {source.key: source for source in SOURCES}
    for key in paths:
        if key not in keys:
            raise params.unknown(f"preprocess.sources.{key}", key, keys)
    return [(source, path) for source in SOURCES if (path := paths.get(source.key)) is not None]


def recognise_sources(path: Path) -> list[Listing]:
    """Return the sources that lie in `path`, or around it when it is a part of one.

    Raises UsageError for a path that is missing or no folder, ContentError when nothing that is known lies there.
    """
    if not path.is_dir():
        raise UsageError(f"{path} is {'no folder' if path.exists() else 'missing'}", "give the folder that the data was unpacked to")
    root = path.resolve()
    listings: dict[str, Listing] = {}
    try:
        for source in SOURCES:
            # What was made of a dataset often lies beside it: then it has to be named itself.
            if not source.replaces & listings.keys() and (folder := source.recognise(root)):
                listings[source.key] = source.list(folder, PreprocessSettings())
    except PermissionError as error:
        raise ContentError(f"{error.filename} cannot be read", "give yourself the right to read it") from error
    if not listings:
        *most, last = (source.expected for source in SOURCES)
        raise ContentError(f"{path} holds no data set that is known here", f"it should hold {', '.join(most)}, or {last}")
    return list(listings.values())

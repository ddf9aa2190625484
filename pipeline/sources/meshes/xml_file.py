"""XML from strangers: no DTD, no entity, nothing fetched, not too many elements."""

from typing import Any

import defusedxml
from defusedxml import ElementTree

from pipeline.sources.reasons import SourceError


def xml_root(data: bytes, code: str, where: str, most: int) -> Any:
    """Return the root element of a document of at most `most` opening brackets.

    Raises SourceError `too_large`, or `code` for what is not XML or holds a DTD, an entity or an external reference, naming `where`.
    """
    if data.count(b"<") > most:
        raise SourceError("too_large", where, "has too many elements")
    try:
        return ElementTree.fromstring(data, forbid_dtd=True)
    except defusedxml.DefusedXmlException as error:
        raise SourceError(code, where, "has a DTD, an entity or an external reference") from error
    except (ElementTree.ParseError, ValueError, LookupError, RecursionError) as error:
        raise SourceError(code, where, f"is not XML ({str(error)[:80]})") from error

"""Pictures of homes: top views, contact sheets, path-traced views."""

from pipeline.preview.sheet import contact_sheet
from pipeline.preview.top import top_view
from pipeline.preview.trace import path_trace
from pipeline.rendering.thumbnail import thumbnail

__all__ = ["contact_sheet", "path_trace", "thumbnail", "top_view"]

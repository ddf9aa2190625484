"""Texture images: checked, bounded, and scaled down to a size that a dataset of thousands of assets can carry."""

import io

from PIL import Image, UnidentifiedImageError

from pipeline.sources.reasons import SourceError

MAX_FILE = 32 << 20  # bytes
MAX_PIXELS = 4096 * 4096


def prepare_texture(data: bytes, where: str, limit: int) -> tuple[bytes, str]:
    """Return (bytes, suffix) of an image of at most `limit` pixels a side.

    A small PNG or JPEG stays as it is; anything else is re-encoded as PNG with fixed settings, so the bytes depend on
    the image alone. Raises SourceError `missing_texture` for what is no such image.
    """
    try:
        with Image.open(io.BytesIO(data), formats=("PNG", "JPEG")) as image:
            if image.width * image.height > MAX_PIXELS:
                raise SourceError("missing_texture", where, f"{image.width} x {image.height} pixels")
            if max(image.size) <= limit:
                suffix = "png" if image.format == "PNG" else "jpg"
                image.load()  # a truncated image fails here, not in a viewer
                return data, suffix
            mode = "RGBA" if "A" in image.getbands() or "transparency" in image.info else "RGB"
            small = image.convert(mode)
            small.thumbnail((limit, limit), Image.Resampling.LANCZOS)
            out = io.BytesIO()
            small.save(out, "PNG", optimize=False, compress_level=6)
            return out.getvalue(), "png"
    except (UnidentifiedImageError, OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        told = str(error).split(" <")[0]  # without the buffer's address, which is another in every run
        raise SourceError("missing_texture", where, f"is no readable PNG or JPEG ({told[:60]})") from error

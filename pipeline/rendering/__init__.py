"""The rasteriser and the colours that previews, thumbnails and image metrics share."""

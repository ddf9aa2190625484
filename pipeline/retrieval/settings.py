"""The numbers of retrieval that stand in params.yaml."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RetrievalSettings:
    """How an asset is chosen (section `retrieval` of params.yaml)."""

    latent_weight: float = 0.3  # weight of the standardised latent's rms difference
    size_weight: float = 2.0  # weight of the rms log ratio of the sizes
    prefer_openable: float = 1.5  # assets that do not open are so many times as far, where the category has some that do
    prefer_offset: float = 0.15  # and this much farther, so that a near-perfect static match does not always win
    prefer_style: float = 1.5  # where a style is asked for: assets of another are so much farther
    prefer_taste: float = 0.3  # the same where nobody asked for the style that was drawn for the home
    prefer_finish: float = 0.25  # so much farther is an asset whose finish is 30 (CIELAB) from the room's, at most twice that
    shortlist: int = 8  # nearest assets whose finishes are looked at
    stretch: float = 0.15  # largest change of a static asset's size per axis; articulated ones are never scaled
    sweep_boxes: int = 4  # boxes kept per asset for the articulated-collision guidance

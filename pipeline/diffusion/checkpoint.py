"""Weights of the layout model on disk."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from torch import nn

from pipeline import taxonomy
from pipeline.diffusion.codec import CHANNELS, Normalisation
from pipeline.diffusion.inventory import Inventory
from pipeline.diffusion.set_transformer import SetTransformer
from pipeline.diffusion.settings import MOST_SLOTS, ModelSettings
from pipeline.errors import ContentError
from pipeline.manifest import canonical
from pipeline.tensors import build_header, flatten, grouped, load_state, load_tensors, read_header, save_tensors

FORMAT = "sfgen-denoiser-7"
REMEDY = "run `make run`, or `dvc repro train`, which makes it"


@dataclass(frozen=True, slots=True)
class Header:
    """What travels with the weights: normalisation and classes, layout types in order, most objects of a room, the net's shape."""

    norm: Normalisation
    layouts: tuple[str, ...]
    slots: int
    model: ModelSettings
    inventory_width: int

    def fault(self) -> str:
        """Return what is wrong with it, "" where nothing is."""
        norm, names = self.norm, self.norm.classes
        tables = (norm.mean, norm.scale)
        if any(not some or len(set(some)) < len(some) for some in (names, self.layouts)):
            return "categories or room types are missing, or there twice"
        if any(len(table) != len(names) or any(len(row) != CHANNELS for row in table) for table in tables):
            return f"norm is no table of {len(names)} categories by {CHANNELS} channels"
        if min(map(min, norm.scale)) <= 0:
            return "norm has a deviation that is not above 0"
        if not 1 <= self.slots <= MOST_SLOTS:
            return f"slots is {self.slots}, not 1 to {MOST_SLOTS}"
        shape = self.model
        if min(self.inventory_width, *asdict(shape).values()) < 1 or shape.width % shape.heads:
            return "no net has this shape"
        return ""


def build_net(header: Header) -> SetTransformer:
    """Build the net that a header describes."""
    return SetTransformer(header.norm, len(header.layouts), header.model)


def build_inventory(header: Header) -> Inventory:
    """Build the inventory model that a header describes."""
    return Inventory(len(header.norm.classes), len(header.layouts), header.inventory_width)


def save_weights(path: Path, header: Header, nets: Mapping[str, nn.Module]) -> None:
    """Write the weights of a layout model: its `denoiser` and its `inventory`."""
    text = canonical({"format": FORMAT, **asdict(header)}).decode()
    save_tensors(path, flatten({name: net.state_dict() for name, net in nets.items()}), {"layout": text})


def load_weights(path: Path) -> tuple[SetTransformer, Inventory, Header]:
    """Read a layout model. Raises ContentError when the file is missing, truncated, of another format, or holds what is no number or describes no net."""
    tensors, headers = load_tensors(path, REMEDY)
    header = build_header(Header, read_header(path, headers, "layout", FORMAT, REMEDY), "layout", path, REMEDY)
    if fault := header.fault():
        raise ContentError(f"{path}: {fault}", REMEDY)
    groups = grouped(path, tensors, REMEDY)
    denoiser, inventory = build_net(header), build_inventory(header)
    load_state(denoiser, groups.get("denoiser", {}), path, REMEDY)
    load_state(inventory, groups.get("inventory", {}), path, REMEDY)
    return denoiser.eval(), inventory.eval(), header


def require_vocabulary(path: Path, header: Header, remedy: str = REMEDY) -> None:
    """Raise ContentError where weights know other categories or room types than manifests/, or know them in another order."""
    words = taxonomy.load()
    for what, own, known in (("categories", header.norm.classes, words.names), ("room types", header.layouts, words.layout_types)):
        if own != known:
            odd = sorted(set(own) ^ set(known)) or ["their order"]
            raise ContentError(f"{path} knows other {what} than the taxonomy: {', '.join(odd[:5])}", remedy)

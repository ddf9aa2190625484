"""The usual Inception-v3 of FID, from a file that the user has: a TorchScript module from images to features.

Such as NVIDIA's conversion of the 2015 weights, which takes 8-bit images (B, 3, H, W) and, told `return_features=True`,
gives 2,048 numbers each. Nothing is downloaded.
"""

from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray
from torch.nn.functional import interpolate

from pipeline.errors import ContentError

PIXELS = 299
BATCH = 16


def inception(path: Path) -> torch.jit.ScriptModule:
    """Load the module. Raises ContentError when the file is missing or holds something else."""
    remedy = "name a TorchScript file of Inception-v3 in metrics.inception, or leave it empty"
    if not path.is_file():
        raise ContentError(f"{path} is missing", remedy)
    try:
        module: torch.jit.ScriptModule = torch.jit.load(str(path), map_location="cpu").eval()
    except (RuntimeError, ValueError) as error:
        raise ContentError(f"{path} is no TorchScript module ({str(error).splitlines()[0]})", remedy) from error
    return module


def embed(module: torch.jit.ScriptModule, views: NDArray[np.uint8]) -> NDArray[np.float64]:
    """Return the features (N, D) of views (N, H, W, 3)."""
    features = []
    with torch.inference_mode():
        for k in range(0, len(views), BATCH):
            images = torch.from_numpy(views[k : k + BATCH]).permute(0, 3, 1, 2).float()
            larger = interpolate(images, (PIXELS, PIXELS), mode="bilinear", antialias=True).round().to(torch.uint8)
            features.append(module(larger, return_features=True).double())
    return np.asarray(torch.cat(features).numpy())

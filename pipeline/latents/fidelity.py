"""How much of a shape survives: what the decoder makes of it, beside what two samples of one shape differ by."""

import torch

from pipeline.latents.vae import PointVae, chamfer, kl_to_standard_normal

COMPARED = 64  # shapes that are measured, spread evenly over all


@torch.no_grad()
def rebuilt(net: PointVae, clouds: torch.Tensor) -> dict[str, float]:
    """Return the mean Chamfer distance between shapes and what the decoder makes of their means, and the mean KL, over shapes spread evenly."""
    part = clouds[torch.linspace(0, len(clouds) - 1, min(len(clouds), COMPARED)).long()]
    mean, logvar = net.encoder(part)
    distance, kl = chamfer(part, net.decoder(mean)), kl_to_standard_normal(mean, logvar)
    return {"chamfer": round(float(distance.mean()), 6), "kl": round(float(kl.mean()), 6)}


def two_samples(first: torch.Tensor, second: torch.Tensor) -> float:
    """Return the mean Chamfer distance between two samples of one shape, over shapes spread evenly: what no net can be better than."""
    rows = torch.linspace(0, len(first) - 1, min(len(first), COMPARED)).long()
    return float(torch.cat([chamfer(first[part], second[part]) for part in rows.split(8)]).mean())

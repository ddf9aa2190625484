"""DVC stage `encode`: a point-cloud VAE over the assets' surfaces; stores the mean of the posterior. A training that was killed goes on.

Reads data/tables/assets.parquet and data/assets/, writes data/latents/latents.parquet (with the assets' finishes), models/vae.safetensors and
metrics/encode.json.
"""

import os
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import torch
from tqdm import tqdm

from pipeline import params, seeds, tables
from pipeline.entities.files import load_asset
from pipeline.entry import run
from pipeline.errors import ContentError
from pipeline.latents.surface import surface_points, triangles
from pipeline.latents.training import encode, fidelity, init_vae, self_ranking, train
from pipeline.latents.vae import FORMAT, EncodeSettings, PointVae, chamfer, load_vae, save_vae
from pipeline.manifest import digest, sha256, write_json
from pipeline.rendering.surface_colour import finish_of
from pipeline.tensors import Checkpoint
from schemas import ASSETS, LATENTS

Row = dict[str, Any]
RELEASED = "weights/vae.safetensors"
CHECKPOINT = "models/vae_checkpoint.safetensors"  # of a training that was killed


def main(root: Path) -> None:
    """Train on the assets of split train, or take the released encoder; encode all, and measure how well shapes are told apart."""
    tree = params.read(root / "params.yaml")
    settings, seed = params.section(EncodeSettings, tree, "encode"), int(tree["seed"])
    torch.set_num_threads(settings.threads or os.cpu_count() or 1)
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    rows = sorted(tables.read(root / "data/tables/assets.parquet", ASSETS), key=lambda r: str(r["asset_id"]))
    if not rows:
        raise ContentError(f"{root / 'data/tables/assets.parquet'} lists no asset", "run `dvc repro preprocess` again")
    # Assets that are one model at several scales (PartNet objects serving several categories) have one shape.
    shapes = {(r["source"], r["source_id"]): r for r in reversed(rows)}
    order = sorted(shapes)
    first, second, finishes = surfaces(root / "data/assets", [shapes[k] for k in order], settings.points, seed)
    learnt = [i for i, k in enumerate(order) if shapes[k]["split"] == "train"] or list(range(len(order)))
    net, untrained = init_vae(seed, settings), init_vae(seed, settings)
    if settings.start == "released":
        net = load_released(root / RELEASED, settings)
    else:
        clouds, threads = first[learnt], torch.get_num_threads()
        key = digest([FORMAT, asdict(settings), seed, threads, device.type, sha256(clouds.numpy().tobytes())])
        kept = Checkpoint(root / CHECKPOINT, key)
        for _ in tqdm(train(seed, net, clouds, settings, device, kept), total=settings.steps, desc="encode", unit="step"):
            pass
    save_vae(root / "models/vae.safetensors", net, settings)
    (root / CHECKPOINT).unlink(missing_ok=True)
    means = encode(net, first, device).numpy()
    known = {k: {"latent": mean.tolist(), "finish": finish} for k, mean, finish in zip(order, means, finishes, strict=True)}
    latents = [{"asset_id": r["asset_id"], **known[r["source"], r["source_id"]]} for r in rows]
    tables.write(root / "data/latents/latents.parquet", LATENTS, latents)
    held_out = [i for i, k in enumerate(order) if shapes[k]["split"] != "train"]
    served: dict[tuple[str, str], set[str]] = {}
    for row in rows:
        served.setdefault((row["source"], row["source_id"]), set()).add(row["category"])
    counts = {"shapes": len(order), "assets": len(rows)}
    report = counts | fidelity(net.cpu(), first, second)
    for name, model in (("trained", net), ("untrained", untrained)):
        stored, queries = (encode(model, cloud, device).numpy() for cloud in (first, second))
        for part, asked in (("held_out", held_out), ("all", list(range(len(order))))):
            ranking = self_ranking(stored, queries, [min(served[k]) for k in order], asked, *twins(first, second))
            report[f"self_rank_{part}_{name}"] = round(ranking.rate, 6)
            report[f"asked_{part}"] = ranking.asked
            report[f"twins_{part}_{name}"] = ranking.excused
    write_json(root / "metrics/encode.json", report)


def surfaces(folder: Path, rows: list[Row], points: int, seed: int) -> tuple[torch.Tensor, torch.Tensor, list[list[float] | None]]:
    """Return two independent surface samples (M, P, 3) of each row's asset, the first of which is stored, and its finish (3,), None where it has none."""
    finishes: list[list[float] | None] = []
    samples: tuple[list[np.ndarray[Any, Any]], list[np.ndarray[Any, Any]]] = ([], [])
    for row in tqdm(rows, desc="surfaces", unit="asset"):
        asset = load_asset(folder / row["file"])
        corners, finish = triangles(asset), finish_of(asset)
        finishes.append(None if np.isnan(finish).any() else finish.tolist())
        for number, sample in enumerate(samples):
            rng = seeds.generator(seed, "surface", row["source"], row["source_id"], number)
            sample.append(surface_points(rng, corners, points))
    return torch.from_numpy(np.stack(samples[0])), torch.from_numpy(np.stack(samples[1])), finishes


def load_released(path: Path, settings: EncodeSettings) -> PointVae:
    """Read the released encoder. Raises ContentError when its shape is not the one that is asked for."""
    net, own_settings = load_vae(path)
    shape = ("width", "latent", "decoded_points")
    if any(getattr(own_settings, name) != getattr(settings, name) for name in shape):
        have = ", ".join(f"{name} {getattr(own_settings, name)}" for name in shape)
        raise ContentError(
            f"{path} holds an encoder of another shape ({have})", "set encode.start: scratch in params.yaml, or these numbers"
        )
    return net


def twins(first: torch.Tensor, second: torch.Tensor) -> tuple[Callable[[int, int], float], Callable[[int], float]]:
    """Return the Chamfer distance between two shapes, and that between the two samples of one: closer shapes are twins."""

    def between(i: int, j: int) -> float:
        return float(chamfer(first[i : i + 1], first[j : j + 1])[0])

    def itself(i: int) -> float:
        return float(chamfer(first[i : i + 1], second[i : i + 1])[0])

    return between, itself


if __name__ == "__main__":
    run(main)

"""The paper's tables from trials: quantity, walkable area, articulation, ablation, categories."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from pipeline.entities.asset import Asset
from pipeline.experiments.settings import MetricsSettings
from pipeline.experiments.trials import Condition, Trial
from pipeline.homes.rows import Row
from pipeline.metrics import articulation, category, collision, openable, quantity, reach, walkable

Trials = Mapping[str, Trial]
Json = dict[str, Any]


def conditions(settings: MetricsSettings) -> list[Condition]:
    """Return every condition that the tables need, by name."""
    made = [Condition("plain", quantity=False, articulation="none"), Condition("guided"), Condition("heuristic", articulation="heuristic")]
    for n in settings.counts:
        made += [
            Condition(f"count_{n}", count=n),
            Condition(f"count_{n}_plain", count=n, quantity=False, articulation="none", finished=False),
        ]
    made += [Condition(f"walkable_{tau:.2f}", walkable=tau) for tau in settings.taus]
    middle = settings.taus[len(settings.taus) // 2]
    made.append(Condition("plain_walkable", quantity=False, articulation="none", walkable=middle))
    return made


def quantity_table(trials: Trials, counts: Sequence[int], rooms: int) -> Json:
    """Return SR(N): the net alone, with guidance over all first attempts, and over the rooms that ship (with how many ship)."""
    made: Json = {}
    for n in counts:
        guided, plain = trials[f"count_{n}"], trials[f"count_{n}_plain"]
        made[str(n)] = {
            "plain": quantity.from_rooms(plain.first["rooms"])[str(n)],
            "first": quantity.from_rooms(guided.first["rooms"])[str(n)],
            "shipped": quantity.from_rooms(guided.shipped["rooms"]).get(str(n), {}),
            "ships": len(guided.shipped["rooms"]) / rooms,
        }
    return made


def walkable_table(trials: Trials, taus: Sequence[float], rooms: int) -> Json:
    """Return SR(tau) in both meanings: without control, and over the rooms that ship with it."""
    made: Json = {}
    plain = trials["guided"].shipped["rooms"]
    for tau in taus:
        ours = trials[f"walkable_{tau:.2f}"].shipped["rooms"]
        made[f"{tau:.2f}"] = {
            meaning: {
                "without": walkable.success_rate([float(r[f"walkable_{meaning}"]) for r in plain], tau),
                "with": walkable.success_rate([float(r[f"walkable_{meaning}"]) for r in ours], tau),
            }
            for meaning in walkable.MEANINGS
        } | {"ships": len(ours) / rooms}
    return made


def articulation_table(rng: np.random.Generator, trials: Trials, sweeps: articulation.Sweeps, assets: Mapping[str, Asset]) -> Json:
    """Return R_acoll, R_reach, Col_obj and openable objects: without guidance, with the paper's heuristic, with the joints' sweeps."""
    made: Json = {}
    for name in ("plain", "heuristic", "guided"):
        for stage, rows in (("first", trials[name].first), ("shipped", trials[name].shipped)):
            made[f"{name}_{stage}"] = figures(rng, rows, sweeps, assets)
    return made


def figures(rng: np.random.Generator, rows: Mapping[str, list[Row]], sweeps: articulation.Sweeps, assets: Mapping[str, Asset]) -> Json:
    """Return every figure of articulation and collision for rows of rooms, objects and joints."""
    return {
        "r_acoll_heuristic": articulation.acoll(rng, rows["objects"], "heuristic"),
        "r_acoll_joints": articulation.acoll(rng, rows["objects"], "joints", sweeps),
        "swept": articulation.swept(rows["joints"]),
        "r_reach": reach.reach(rng, rows["rooms"], rows["objects"]),
        "reach": reach.openable_reach(rows["joints"]),
        "collision": collision.rates(rows["objects"], assets),
        "openable": openable.per_room(rng, rows["rooms"]),
        "walkable": walkable.means(rng, rows["rooms"]),
    }


def ablation_table(rng: np.random.Generator, trials: Trials, taus: Sequence[float]) -> Json:
    """Return the paper's ablation: Col_obj, R_walkable, R_reach with each of the two mechanisms on and off, as shipped and as drafted."""
    middle = f"walkable_{taus[len(taus) // 2]:.2f}"
    named = {
        "neither": trials["plain"].first,
        "articulation": trials["guided"].first,
        "walkable": trials["plain_walkable"].shipped,
        "both": trials[middle].shipped,
    }
    return {
        name: {
            "col_obj": collision.rates(rows["objects"])["bbox"]["col_obj"],
            "r_walkable": walkable.means(rng, rows["rooms"]),
            "r_reach": reach.reach(rng, rows["rooms"], rows["objects"]),
        }
        for name, rows in named.items()
    }


def category_table(trials: Trials, real: Iterable[Row], held_out: Iterable[Row], names: Sequence[str]) -> Json:
    """Return CKL of the rooms drafted for the held-out floors against the held-out rooms; the noise floor is train against held out."""
    truth = list(held_out)
    return {
        "train_against_test": category.ckl(truth, real, names),
        "plain": category.ckl(truth, trials["plain"].first["objects"], names),
        "guided": category.ckl(truth, trials["guided"].first["objects"], names),
        "shipped": category.ckl(truth, trials["guided"].shipped["objects"], names),
    }


def curves(figures: Mapping[str, Any]) -> dict[str, str]:
    """Return the plots' data as CSV by name: what `dvc plots show` draws."""
    counts = ["n,guidance,rate,low,high"]
    for n, row in figures["quantity"].items():
        counts += [f"{n},{k},{v['rate']},{v['low']},{v['high']}" for k, v in row.items() if k in {"plain", "first", "shipped"} and v]
    taus = ["tau,control,rate,low,high"]
    for tau, row in figures["walkable"].items():
        taus += [f"{tau},{k},{v['rate']},{v['low']},{v['high']}" for k, v in row["free"].items()]
    return {"quantity": "\n".join(counts) + "\n", "walkable": "\n".join(taus) + "\n"}

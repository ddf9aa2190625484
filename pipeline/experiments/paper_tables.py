"""The paper's tables from trials: quantity, walkable area, articulation, ablation, categories."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from pipeline.entities.asset import Asset
from pipeline.experiments.settings import MetricsSettings
from pipeline.experiments.trials import Condition, Trial
from pipeline.homes.rows import Row
from pipeline.metrics import collision, control, reach
from pipeline.metrics.two_samples import ckl

ALL_PLAIN, ALL_GUIDED = "all_plain", "all_guided"  # the conditions that furnish every room of the split
Trials = Mapping[str, Trial]
Json = dict[str, Any]


def families(settings: MetricsSettings) -> list[list[Condition]]:
    """Return every condition that the tables need, by what the layout model is told: one family's rooms come from the same drafts.

    The families that take longest come first, so that no worker is left alone at the end.
    """
    groups = [[Condition(f"walkable_{tau:.2f}", walkable=tau) for tau in sorted(settings.taus, reverse=True)]]
    groups[0] += [Condition("guided")]
    groups += [[Condition(ALL_GUIDED)]]  # would share the first family's drafts, but that one takes longest already
    plain = Condition("plain", articulation="none")
    middle = settings.taus[len(settings.taus) // 2]
    groups += [[replace(plain, name="plain_walkable", walkable=middle), plain, replace(plain, name=ALL_PLAIN, finished=False)]]
    groups += [[Condition(f"count_{n}", count=n)] for n in sorted(settings.counts, reverse=True)]
    groups += [[replace(plain, name=f"count_{n}_plain", count=n, finished=False)] for n in settings.counts]
    groups += [[Condition("heuristic", articulation="heuristic", finished=False)]]
    return groups


def quantity_table(trials: Trials, counts: Sequence[int], rooms: int) -> Json:
    """Return SR(N): without guidance; guided, as drafted and after post-optimisation, over all first attempts; as shipped."""
    table: Json = {}
    for n in counts:
        guided, plain = trials[f"count_{n}"], trials[f"count_{n}_plain"]
        table[str(n)] = {
            "plain": control.quantity(plain.drafted["rooms"])[str(n)],
            "drafted": control.quantity(guided.drafted["rooms"])[str(n)],
            "first": control.quantity(guided.first["rooms"])[str(n)],
            "shipped": control.quantity(guided.shipped["rooms"]).get(str(n), {}),
            "ships": len(guided.shipped["rooms"]) / rooms,
        }
    return table


def walkable_table(trials: Trials, taus: Sequence[float], rooms: int) -> Json:
    """Return SR(tau) in both meanings: without control, with it over all first attempts, and over the rooms that ship."""
    table: Json = {}
    plain = trials["guided"].shipped["rooms"]
    for tau in taus:
        asked = trials[f"walkable_{tau:.2f}"]
        sets = {"without": plain, "first": asked.first["rooms"], "with": asked.shipped["rooms"]}
        table[f"{tau:.2f}"] = {
            meaning: {name: control.walkable(rows, meaning, tau) for name, rows in sets.items()} for meaning in control.MEANINGS
        } | {"ships": len(sets["with"]) / rooms}
    return table


def articulation_table(rng: np.random.Generator, trials: Trials, sweeps: collision.Sweeps, assets: Mapping[str, Asset]) -> Json:
    """Return R_acoll, R_reach, Col_obj and openable objects: without guidance, with the paper's heuristic, with the joints' sweeps."""
    drafted = {f"{name}_drafted": trials[name].drafted for name in ("plain", "heuristic", "guided")}
    shipped = {f"{name}_shipped": trials[name].shipped for name in ("plain", "guided")}
    return {name: figures(rng, rows, sweeps, assets) for name, rows in (drafted | shipped).items()}


def figures(rng: np.random.Generator, rows: Mapping[str, list[Row]], sweeps: collision.Sweeps, assets: Mapping[str, Asset]) -> Json:
    """Return every figure of articulation and collision for rows of rooms, objects and joints."""
    return {
        "r_acoll_heuristic": collision.acoll(rng, rows["objects"], "heuristic"),
        "r_acoll_joints": collision.acoll(rng, rows["objects"], "joints", sweeps),
        "swept": collision.swept(rows["joints"]),
        "r_reach": reach.reach(rng, rows["rooms"], rows["objects"]),
        "reach": collision.openable_reach(rows["joints"]),
        "collision": collision.rates(rows["objects"], assets),
        "openable": control.openable(rng, rows["rooms"]),
        "walkable": control.walkable_means(rng, rows["rooms"]),
    }


def ablation_table(rng: np.random.Generator, trials: Trials, taus: Sequence[float]) -> Json:
    """Return the paper's ablation: Col_obj, R_walkable, R_reach with each of the two mechanisms on and off, as shipped and as drafted."""
    middle = f"walkable_{taus[len(taus) // 2]:.2f}"
    named = {
        "neither": trials["plain"].drafted,
        "articulation": trials["guided"].drafted,
        "walkable": trials["plain_walkable"].shipped,
        "both": trials[middle].shipped,
    }
    return {
        name: {
            "col_obj": collision.rates(rows["objects"])["bbox"]["col_obj"],
            "r_walkable": control.walkable_means(rng, rows["rooms"]),
            "r_reach": reach.reach(rng, rows["rooms"], rows["objects"]),
        }
        for name, rows in named.items()
    }


def category_table(trials: Trials, real: Iterable[Row], held_out: Iterable[Row], names: Sequence[str]) -> Json:
    """Return CKL of what is drafted for the held-out floors against what stands there; the noise floor is train against it.

    Only what the layout model learns (`names`) is compared: small things and textiles are no part of a draft.
    """
    known = set(names)
    truth, learnt = ([row for row in rows if row["category"] in known] for rows in (held_out, real))
    return {
        "train_against_test": ckl(truth, learnt, names),
        "plain": ckl(truth, trials[ALL_PLAIN].drafted["objects"], names),
        "guided": ckl(truth, trials[ALL_GUIDED].drafted["objects"], names),
    }


def curves(figures: Mapping[str, Any]) -> dict[str, str]:
    """Return the plots' data as CSV by name: what `dvc plots show` draws."""
    counts = ["n,guidance,rate,low,high"]
    for n, row in figures["quantity"].items():
        counts += [f"{n},{k},{v['rate']},{v['low']},{v['high']}" for k, v in row.items() if k != "ships" and v]
    taus = ["tau,control,rate,low,high"]
    for tau, row in figures["walkable"].items():
        taus += [f"{tau},{k},{v['rate']},{v['low']},{v['high']}" for k, v in row["free"].items()]
    return {"quantity": "\n".join(counts) + "\n", "walkable": "\n".join(taus) + "\n"}

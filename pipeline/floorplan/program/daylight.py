"""Which rooms of a storey can lie at outside walls together, given what is joined: a planar graph with one vertex for the outside."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from pipeline.floorplan.program.floor_program import Link

# Who gives up an outside wall first where not all can have one.
YIELDS = (
    "utility",
    "storage",
    "entry",
    "hallway",
    "gym",
    "library",
    "media_room",
    "sunroom",
    "balcony",
    "playroom",
    "office",
    "dining_room",
)


def is_flat(links: Sequence[Link], outside: Collection[str]) -> bool:
    """Whether rooms can be drawn so that linked ones touch and those of `outside` lie at the outline."""
    rooms = {i for k in links for i in (k.a, k.b)}
    if len(links) < max(len(rooms), 3):
        return True  # hardly a ring of rooms: nothing is enclosed
    import networkx as nx

    graph = nx.Graph([(k.a, k.b) for k in links])
    graph.add_edges_from((i, "") for i in outside)
    return bool(nx.check_planarity(graph)[0])


def daylit(links: Sequence[Link], must: Sequence[str], wish: Sequence[tuple[str, str]]) -> set[str]:
    """Return which rooms of `wish` (id, type) can have an outside wall beside those of `must`: all, or the most private first."""
    if is_flat(links, [*must, *(i for i, _ in wish)]):
        return {i for i, _ in wish}
    kept: list[str] = []
    rank = {t: len(YIELDS) - k for k, t in enumerate(YIELDS)}
    for i, _ in sorted(wish, key=lambda w: rank.get(w[1], 0)):
        if is_flat(links, [*must, *kept, i]):
            kept.append(i)
    return set(kept)

"""Which rooms of a storey can lie at outside walls together, given what is joined: a planar graph with one vertex for the outside."""

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

FEW = 2  # edges of a room that do not matter for planarity
SMALLEST = 9  # edges of the smallest graph that cannot be drawn without crossings, K3,3


def is_flat(links: Sequence[Link], outside: Collection[str]) -> bool:
    """Whether rooms can be drawn so that linked ones touch and those of `outside` lie at the outline."""
    edges = core([*((k.a, k.b) for k in links), *((i, "") for i in outside)])
    if len(edges) < SMALLEST:
        return True
    import networkx as nx  # seldom needed, and as slow to load as a home is to plan

    return bool(nx.check_planarity(nx.Graph(edges))[0])


def core(edges: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return a smaller graph that is planar just when this one is: ends of one edge are left out, those of two become an edge between their neighbours."""
    beside: dict[str, set[str]] = {}
    for a, b in edges:
        if a != b:
            beside.setdefault(a, set()).add(b)
            beside.setdefault(b, set()).add(a)
    while (thin := next((room for room, near in beside.items() if len(near) <= FEW), None)) is not None:
        near = sorted(beside.pop(thin))
        for other in near:
            beside[other].discard(thin)
            beside[other].update(n for n in near if n != other)
    return [(a, b) for a, near in beside.items() for b in sorted(near) if a < b]


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

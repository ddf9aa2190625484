"""The moves that all room types share: a piece against a wall, beside another, a chair at a desk, a lamp overhead."""

import functools
import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from pipeline.card import cards
from pipeline.corpus.furniture.catalogue import Model
from pipeline.corpus.houses.rates import Deal, Rates
from pipeline.corpus.houses.room_occupancy import Space, Spot, against, ahead, box_of, filler, shift_spot
from pipeline.corpus.houses.stock import Stock

LAMP_DROP = 0.02


def free_front(category: str, default: float) -> float:
    """Return the free depth before a front that opens or is sat at [m]."""
    front = cards()[category].corpus.front
    return default if front is None else front


class Arranger:
    """Furnishes one room: the generator, the room, the stock, the house's style and the room's decisions in one hand.

    What is placed where is drawn from the generator; what is tried at all, from `rates`, is dealt in strata.
    """

    def __init__(self, rng: np.random.Generator, space: Space, stock: Stock, style: str, rates: Rates, deal: Deal) -> None:
        self.rng = rng
        self.space = space
        self.stock = stock
        self.style = style
        self.rates = rates
        self.deal = deal

    def wants(self, decision: str) -> bool:
        """Return the room's decision on a chance of its rates."""
        return self.deal.mark(decision) < float(self.rates[decision])

    def choose(self, decision: str) -> str:
        """Return the room's choice among alternatives of its rates."""
        return self.deal.choose(decision, self.rates[decision])

    def wishes(self, group: str) -> list[str]:
        """Return the categories of a group that the room wants; `second_chair` is one more chair.

        Some rooms are crowded and some bare: a room's wealth, 1 in the mean, multiplies its chances for extras.
        """
        rates: Mapping[str, float] = self.rates[group]
        wealth = 3.0 * self.deal.mark("wealth") ** 2 if group == "extras" else 1.0
        return [name.removeprefix("second_") for name, share in rates.items() if self.deal.mark(f"{group}.{name}") < share * wealth]

    def chance(self, share: float) -> bool:
        """Return True in that share of cases."""
        return bool(self.rng.random() < share)

    def pick(self, category: str, width: float = math.inf, depth: float = math.inf, height: float = math.inf) -> Model | None:
        """Draw a model of the category within the limits [m]."""
        return self.stock.pick(self.rng, category, self.style, (width, depth, min(height, self.space.height - 0.02)))

    def smaller(self, category: str, tries: int, by: float, width: float = math.inf, depth: float = math.inf) -> Iterator[Model]:
        """Draw models of the category within the limits [m] to try in turn: each at most `by` times as wide as the one before."""
        for _ in range(tries):
            model = self.pick(category, width=width, depth=depth)
            if model is None:
                return
            yield model
            width = model.size[0] * by

    def at_wall(self, category: str, *, corner: float = 0.6, tries: int = 3) -> bool:
        """Put a piece of the category with its back to a wall, its front free; smaller models after a failure."""
        front = free_front(category, 0.35)
        for model in self.smaller(category, tries, 0.95):
            spot = against(self.rng, self.space, model, front=front, corner=corner)
            if spot is not None and self.space.try_add(
                model, spot, clearances=[ahead(spot, model.size[1], front, model.size[0] + 2 * filler(model))]
            ):
                return True
        return False

    def pair_at_wall(self, table: str) -> bool:
        """Put a desk or dressing table to a wall and the seat that the room chooses ("none": none) before it, facing it."""
        seat = self.pick(self.choose(f"{table.removesuffix('_table')}_seat"))
        front = max(free_front(table, 0.0), seat.size[1] + 0.15 if seat else 0.0)
        for desk in self.smaller(table, 6, 0.9):
            spot = against(self.rng, self.space, desk, front=front, corner=0.55)
            if spot is not None and self.space.try_add(desk, spot):
                if seat is None or self._sit(seat, spot, desk.size[1]):
                    return True
                self.space.take_back()
        return False

    def _sit(self, seat: Model, spot: Spot, depth: float) -> bool:
        """Put a chair before a desk of that depth, turned as somebody left it; straight where there is no room for that."""
        off = float(self.rng.uniform(0.02, 0.1))
        turn = float(self.rng.normal(0, 0.4)) if self.chance(0.85) else 0.0
        place = shift_spot(spot, float(self.rng.normal(0, 0.04)), depth / 2 + seat.size[1] / 2 + off, math.pi)
        askew = shift_spot(place, 0.0, -0.1 if turn else 0.0, turn)
        return self.space.nestle(seat, askew) or self.space.nestle(seat, place)

    def in_corner(self, category: str, front: float | None = None) -> bool:
        """Put a chair or plant into a corner, often turned towards the room."""
        model = self.pick(category)
        if model is None:
            return False
        spot = against(self.rng, self.space, model, front=free_front(category, 0.0) if front is None else front, corner=0.85)
        if spot is None:
            return False
        if category in {"armchair", "lounge_chair", "lazy_sofa", "chaise_longue_sofa"} and self.chance(0.8):
            turn = float(self.rng.choice([-1, 1])) * float(self.rng.uniform(0.3, 0.8))
            bounds = box_of(0, 0, turn, model.size[0], model.size[1])
            turned = shift_spot(spot, 0.0, bounds[3] - model.size[1] / 2, turn)
            if self.space.try_add(model, turned):
                return True
        if category in {"plant", "floor_lamp"} and self.chance(0.4):  # round things stand at any angle
            spot = shift_spot(spot, 0.0, 0.08, float(self.rng.uniform(-0.7, 0.7)))
        return self.space.try_add(model, spot)

    def on_wall(self, category: str, low: float) -> bool:
        """Fix a piece to a wall, its underside `low` above the floor."""
        model = self.pick(category, height=self.space.height - low - 0.05)
        if model is None:
            return False
        spot = against(self.rng, self.space, model, front=0.0, corner=0.0, low=low)
        return spot is not None and self.space.try_add(model, spot, low)

    def lamp(self, category: str, x: float, y: float, yaw: float = 0.0) -> bool:
        """Hang a lamp at (x, y) under the ceiling."""
        most = self.space.height - (1.5 if category == "pendant_lamp" else 1.9)
        model = self.pick(category, height=most)
        if model is None:
            return False
        drop = LAMP_DROP if category == "pendant_lamp" else 0.0
        return self.space.try_add(model, Spot(x, y, yaw), round(self.space.height - model.size[2] - drop, 3))

    def light(self, places: Sequence[tuple[float, float]] = ()) -> None:
        """Hang the lamp that the room wants at the first of the places, or near the middle of the room, where there is room for it."""
        category = self.choose("lamp")
        if category == "none":
            return
        for x, y in (*places, *self.middles()):
            if self.lamp(category, x + float(self.rng.normal(0, 0.03)), y + float(self.rng.normal(0, 0.03))):
                return

    def follow(self, recipe: Sequence[Rates], *, rich: bool) -> None:
        """Take the steps of a recipe of rates.yaml, which says what a step may say; some are for a `rich` room alone."""
        for step in recipe:
            if step.get("rich") and not rich:
                continue
            move = functools.partial(getattr(self, step["move"]), **step.get("how", {}))
            self.space.blind = step.get("blind", False)
            if "each" in step:
                for thing in self.wishes(step["each"]) or step.get("default", ()):
                    move(thing)
            elif "choice" in step:
                move(self.choose(step["choice"]))
            elif "what" not in step:
                move()
            else:
                wanted = step["what"] not in self.rates or self.wants(step["what"])
                placed = wanted and self.space.area > step.get("area", 0.0) and move(step["what"])
                if not placed and "else" in step:
                    move(step["else"])
            self.space.blind = False

    def middles(self) -> list[tuple[float, float]]:
        """Return middles of the room: of its bounds, then of the largest rectangle-like part of an L."""
        x0, y0, x1, y1 = self.space.bounds
        return [((x0 + x1) / 2, (y0 + y1) / 2), *((x0 + (x1 - x0) * a, y0 + (y1 - y0) * b) for a in (0.3, 0.7) for b in (0.3, 0.7))]

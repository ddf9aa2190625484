"""What an amount measures: the room beside it, or the whole home."""

from __future__ import annotations

from pipeline.floorplan.defaults import DEFAULTS
from pipeline.floorplan.language import items as kinds
from pipeline.floorplan.language.facts import Reading
from pipeline.floorplan.language.items import Item


def attach(state: Reading, sentence: list[Item], k: int, subject: tuple[str, ...], near: tuple[str, ...]) -> None:
    """Attach an amount to what it measures: the room beside it, or the home."""
    item = sentence[k]
    state.understood(item)
    if item.unit == "storeys":
        if item.number and item.number >= 1:
            state.storeys = state.storeys or (int(item.number), item)
        return
    before = [i for i in sentence[:k] if i.kind in {kinds.ROOM, kinds.HOME}]
    latest = before[-1] if before else None
    words = [i.words for i in sentence[max(0, k - 3) : k + 3] if i.kind == kinds.WORD] + item.words.split()
    if set(words) & {"total", "altogether", "overall", "totalling"} or (words[:2] == ["in", "all"]):
        state.amounts.append((item, None))
        return
    if latest is not None and latest.kind == kinds.ROOM and latest.ids:
        target = tuple(latest.ids)
        # "a balcony off the living room (6 m2)" measures the balcony
        if set(latest.mods) & {"the", "that"} and subject and target[0] not in subject and item.unit == "area":
            target = tuple(i for i in (near or subject) if not i.startswith("*"))
        loose = sentence[k - 1].kind == kinds.COMMA and sentence[k - 1].words == "," and latest.first >= sentence[k - 1].first - 4
        usual = sum(DEFAULTS[state.inventory.get(i).type].area for i in target)
        whole = state.home is not None and loose and item.unit == "area" and (item.number or 0.0) > 2.5 * usual
        state.amounts.append((item, None if whole else target))
        return
    after = next((i for i in sentence[k + 1 :] if i.kind != kinds.WORD), None)
    if latest is None and after is not None and after.kind == kinds.ROOM and after.ids:
        state.amounts.append((item, tuple(after.ids)))
    else:
        state.amounts.append((item, None))

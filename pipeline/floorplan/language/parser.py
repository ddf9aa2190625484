"""Prompt → FloorProgram, without network and always the same: characters → tokens → phrases → rooms and facts → program; then the rooms that wishes for furniture are for."""

import bisect
import itertools
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NoReturn

from pydantic import ValidationError

from pipeline.errors import RefusedError
from pipeline.floorplan.language.builder import Mention, assemble, room_mentions
from pipeline.floorplan.language.frames import apply_frames, join_brackets
from pipeline.floorplan.language.furnishing import COMMA, COMMAS, STOPS, Claim, Scan
from pipeline.floorplan.language.lexicon import kinds
from pipeline.floorplan.language.phrases import ban, refuse, sentences, settle, take_back
from pipeline.floorplan.language.rooms import Reading, introduce
from pipeline.floorplan.language.sentences import read
from pipeline.floorplan.language.spelling import detect
from pipeline.floorplan.language.text import check_length, has_minus
from pipeline.floorplan.language.tokens import Token, amounts, on_each_level, read_words, segment
from pipeline.floorplan.program.completion import complete
from pipeline.floorplan.program.consistency import ImpossibleError, check
from pipeline.floorplan.program.floor_program import MAX_PIECES, Evidence, FloorProgram, Furniture, Span, Things
from pipeline.floorplan.program.furniture import impossible, merge_wishes, natural

LONGEST_LIST = 400  # characters of a list of wishes
FARTHEST = 24  # characters between a wish and the room that follows it
LARGE = 8  # a number from here on is a size or a count, and missed where nothing took it
HOME = 20.0  # [m2] an area that is a home's even where nothing names one
CLOSE = 4  # the same where nothing but a particle stands between
EMPTY = kinds("empty")
NOT_BUILT = {"unbuilt", "car"}  # a garage is one for one car
STRESS = kinds("stress")  # flags that hold wherever they stand, and such as only underline what is said
POINTING = {"each", "other", "own", "another"}  # determiners that say something
LEADING = {"num", "ord", "adj", "size", "det", "clf", "times", "amount", "fill", "look"}  # in front of a room


def parse(prompt: str) -> FloorProgram:
    """Return the completed program of a prompt in any language that has a lexicon.

    Raises UsageError when it is empty or too long, RefusedError when nothing in it is understood or it contradicts itself.
    """
    program = complete(understand(prompt))
    check(program)
    return program


def understand(prompt: str) -> FloorProgram:
    """Return what the prompt says, and no more: nothing is filled in or checked."""
    check_length(prompt)
    plain, wishes = read_furniture(prompt)
    return attach(understand_rooms(plain, prompt, wishes), wishes, prompt)


def understand_rooms(plain: str, prompt: str, wishes: Sequence[Claim] = ()) -> FloorProgram:
    """Return what a prompt says of rooms, and no more; `plain` is it without its wishes for furniture, all else in its place."""
    words = replace(read_words(plain, detect(prompt)), prompt=prompt)  # words are cited as they were written
    starts = [t.start for t in words.written]  # a token where a wish was taken out: whose it is tells which rooms there are
    places = [bisect.bisect_left(starts, w.start) for w in wishes]
    gaps = [Token("wish", first=k, last=k) for k in places]
    tokens = on_each_level(sorted([*gaps, *amounts(segment(words), words)], key=lambda m: m.first))
    said = [m for m in apply_frames(tokens, words) if m.kind != "wish"]
    refuse(said, words)
    people = [m for m in said if m.kind == "people"]
    tokens = join_brackets([m for m in said if m.kind != "people"], words)
    parsed = sentences(tokens, words)
    everything = [e for s in parsed for e in s]
    named = any(e.kind in {"np", "home"} or (e.kind == "amount" and (e.value == "rooms" or e.number >= HOME)) for e in everything)
    if not named and not people:
        shown = re.sub(r"\s+", " ", prompt.strip())[:60]
        advice = "name rooms, e.g. living room, two bedrooms, bathroom"
        raise RefusedError(f"nothing in the prompt names a room or a home: {shown!r}", advice)
    state = Reading(words, people=next(iter(people), None), looks=[e for e in everything if e.kind == "look"])
    for sentence in parsed:
        ban(sentence)
    take_back(parsed)
    settle(parsed)
    introduce(state, parsed)
    for sentence in parsed:
        read(state, sentence)
    try:
        program = assemble(state, parsed)
    except ValidationError as error:  # a number beyond what a program may hold
        fault = error.errors()[0]
        where = ".".join(map(str, fault["loc"]))
        raise RefusedError(f"{where} cannot be {str(fault['input'])[:60]}: {fault['msg']}", "ask for a home of usual size") from error
    return program.model_copy(update=_left_out(state, parsed, program.evidence, sorted([*tokens, *people[1:]], key=lambda m: m.first)))


def _left_out(state: Reading, parsed: list[list[Token]], evidence: Sequence[Evidence], tokens: Sequence[Token]) -> dict[str, Any]:
    """Return what nothing was made of: `unbuilt`, names of what nobody builds; `unparsed`, words that are in no vocabulary, and words that say something and stand in no evidence."""
    written = state.words.written
    places = [{k for k, t in enumerate(written) if e.start <= t.start and t.end <= e.end} for e in evidence]
    cited = _consumed_words(state, parsed, places, evidence)
    spans: dict[str, list[Span]] = {"unparsed": [], "unbuilt": []}
    for k, token in enumerate(tokens):
        if token.last == token.first:
            continue
        free = not cited & set(range(token.first, token.last))
        named = free and token.value in NOT_BUILT
        if named or token.kind == "word" or (free and _says(state, tokens, k)):
            start, end = written[token.first].start, written[token.last - 1].end
            spans["unbuilt" if named else "unparsed"].append(Span(start=start, end=end, text=state.words.prompt[start:end]))
    return {field: tuple(some) for field, some in spans.items()}


def _consumed_words(state: Reading, parsed: list[list[Token]], places: Sequence[set[int]], evidence: Sequence[Evidence]) -> set[int]:
    """Return the words that something was made of: evidence, what belongs to a phrase in it, and words that only help a statement."""
    cited = state.used.union(*places)
    stated = set().union(*(p for p, e in zip(places, evidence, strict=True) if e.field.split(".")[0] != "rooms" or e.field.count(".") > 1))
    roles = {r.role for r in state.inventory.rooms}
    starred = any("*" in f.a + f.b for f in state.facts) or any(ids == ("*",) for _, ids in state.amounts)
    for sentence in parsed:
        ends = [-1, *(k for k, e in enumerate(sentence) if e.kind in {"comma", "but"}), len(sentence)]
        for a, b in itertools.pairwise(ends):
            part = sentence[a + 1 : b]
            has_statement = bool(part) and bool(stated & set(range(min(e.first for e in part), max(e.last for e in part))))
            has_statement = has_statement or any(e.kind == "flag" and e.value in STRESS for e in part)
            for k, e in enumerate(part):
                if (
                    e.kind == "used"
                    or (e.kind == "owner" and (e.value in roles or any(x.kind in {"np", "home"} for x in part[:k])))
                    or (e.kind == "every" and (starred or has_statement))
                    or (e.kind == "flag" and e.value in STRESS)
                    or (has_statement and (e.kind == "flag" or (e.kind, e.value) in {("cue", "from"), ("adj", "open")}))
                    or (has_statement and e.kind in {"det", "pron"} and (e.ids or e.value != "each"))
                ):
                    cited.update(range(e.first, e.last))
                elif e.kind == "corner" or (e.kind == "np" and (e.ids or e.banned)):
                    cited.update(range(e.first, e.last), *(range(m.first, m.last) for m in e.taken))
    return cited


def _says(state: Reading, tokens: Sequence[Token], k: int) -> bool:
    """Whether the token at k says something by itself."""
    token = tokens[k]
    if token.kind in EMPTY or (token.kind == "det" and token.value not in POINTING):
        return k > 0 and (token.kind, token.value, tokens[k - 1].kind) == ("join", "to", "join")  # "and to a study": something leads there
    if token.kind == "cue":
        return token.value not in {"has", "in"} and token.text not in state.words.lexicon.sign("quiet")
    dweller = token.kind == "owner" and any(m.text in state.words.lexicon.sign("towards") for m in tokens[max(0, k - 2) : k])
    corrects = token.kind == "neg" and next((m.kind for m in tokens[k + 1 :] if m.kind != "comma"), "") == "fix"  # "no, make that three"
    if dweller or corrects or (token.kind, token.value) in {("pron", "it"), ("pron", "one")}:
        return False  # "for my granny: ..." says who lives there
    sized = k and token.kind == "size" and tokens[k - 1].kind == "amount"
    if sized or (token.kind, token.value) in {("adj", "closed"), ("adj", "plain")}:
        return False  # what is not open is apart anyway; "20 m² groß"
    ahead = tokens[k + 1] if k + 1 < len(tokens) else None
    head = next((m for m in tokens[k + 1 :] if m.kind not in LEADING | {"owner", "word"}), None)
    if token.kind in LEADING and head is not None and head.kind == "home":
        return False  # "a shared student flat"
    few = token.kind == "num" and token.number < LARGE  # "three generations"
    return not (few and ahead is not None and ahead.kind in {"owner", "fill", "word", "verb"})


# wishes for furniture, and the rooms that they are for


def read_furniture(prompt: str) -> tuple[str, list[Claim]]:
    """Return the prompt without its wishes for furniture (blanks in their place, so that places hold), and the wishes.

    Raises ImpossibleError for more things than any room may have or fewer than none, and for a share of floor above 100 %.
    """
    scan = Scan(prompt)
    claims = scan.run()
    if not claims:
        return prompt, claims
    for c in claims:
        least, most, start = min(c.least, c.most or 0, c.value), max(c.least, c.most or 0), c.start - has_minus(prompt, c.start)
        if least >= 0 and most <= MAX_PIECES and c.value <= 1.0:
            continue
        said = [Evidence(start=start, end=c.end, text=prompt[start : c.end], field="furniture")]
        what, advice = (f"{c.value:.0%} of a floor", "100% at most") if c.value else (f"{most} things", f"{MAX_PIECES} at most")
        what, advice = ("fewer than none", "numbers above zero") if least < 0 else (what, advice)
        raise ImpossibleError(f"{what} are asked for", f"ask for {advice}", said)
    text = list(prompt)
    for w, gone in zip(scan.words, _blank(scan, claims), strict=True):
        if gone:
            text[w.start : w.end] = " " * (w.end - w.start)
    return "".join(text), claims


def _blank(scan: Scan, claims: Sequence[Claim]) -> list[bool]:
    """Tell which words go: the wishes, what joins them, and what leads to them; rooms whose floor is to stay free are named there."""
    inside = [(k, w) for c in claims if c.kind == "walkable" for k, w in enumerate(scan.words) if c.start <= w.start < c.end]
    at = [k for k, w in inside if w.start in scan.rooms and not scan.length(k - 1, "fraction")]  # "tres cuartos" are no rooms
    named = {scan.words[j].start for k in at for j in (k, k - 1, k - 2) if j == k or scan.length(j, "article") == 1}  # "each bedroom"
    gone = [w.start not in named and any(c.start <= w.start < c.end for c in claims) for w in scan.words]
    for c in (c for c in claims if c.home):  # "everywhere" belongs to the wish for the whole home that it stands by
        for j, w in enumerate(scan.words):
            if c.start - 40 < w.start < c.end + 40 and (step := scan.length(j, "home")):
                gone[j : j + step] = [True] * step
    blank, k = list(gone), 0
    while k < len(gone):
        if not gone[k]:
            k += 1
            continue
        last = j = k
        while j < len(gone) and (gone[j] or (step := scan.length(j, "and", "with", "article"))):  # on over what joins two wishes
            last, j = (j, j + 1) if gone[j] else (last, j + step)
        blank[k : last + 1] = [True] * (last + 1 - k)
        lead = next((n for n in (3, 2, 1) if k - n >= 0 and scan.length(k - n, "with") == n), 0)
        join = scan.length(last + 1, "and") if scan.text(last + 1) not in STOPS else 0
        counted = scan.number(last + 1 + join)[1] is not None  # "two bedrooms with wardrobes and one bathroom": nobody's own
        kinds = ("owned",) if scan.text(last + 1) in COMMAS else ("owned", "own_rooms")
        shared = join and not counted and any(scan.length(i, *kinds) for i in range(last + 1 + join, last + 4 + join))
        if lead and shared:  # a room of the same owner follows: the "and" goes, else the "with"
            blank[last + 1 : last + 1 + join] = [True] * join
        elif lead:
            blank[k - lead : k] = [True] * lead
        k = last + 1
    return blank


def attach(program: FloorProgram, claims: Sequence[Claim], prompt: str, mentions: Sequence[Mention] | None = None) -> FloorProgram:
    """Return the program with the wishes in its rooms and in `furniture`, and their evidence.

    `mentions` are where rooms are named; by default the program's evidence tells. Raises ImpossibleError for wishes that clash.
    """
    if not claims:
        return program
    place = _Place(program, claims, prompt, list(mentions) if mentions is not None else room_mentions(program))
    by_room: dict[str, list[Claim]] = {}
    evidence = []
    for claim in claims:
        every = tuple(r.id for r in program.rooms) if claim.home and claim.kind in {"pieces", "openable"} else ()
        rooms = every or place.of(claim) or ("",)
        choose = claim.kind == "count" and not claim.inward  # "a desk in the bedroom and in the study" is said of both
        usual = next((t for t in natural(claim.name) if choose and t in {place.kinds.get(i) for i in rooms}), "")
        rooms = tuple(i for i in rooms if place.kinds.get(i) == usual) or rooms  # a dining table in one of two halls
        one = replace(claim, least=1) if claim.plural and len(rooms) > 1 else claim  # "two bedrooms with wardrobes"
        for room in rooms:
            by_room.setdefault(room, []).append(one)
            where = f"rooms.{room}.furniture" if room else "furniture"
            field = f"{where}.{claim.name if claim.kind == 'count' else claim.kind}"
            evidence.append(Evidence(start=claim.start, end=claim.end, text=prompt[claim.start : claim.end], field=field))
    wished = {room: combine_claims(some, prompt, room or "the home") for room, some in by_room.items()}
    own = wished.get("", program.furniture)
    cooks = any(c.min and natural(c.category) == ("kitchen",) for c in own.counts)  # a studio's room holds no refrigerator: a kitchen does
    said = {r.id: {"furniture": merge_wishes(r.furniture, wished.get(r.id, Furniture()))} for r in program.rooms}
    apart = {r.id: {"functions": ("living", "sleeping")} for r in program.rooms if cooks and r.type == "studio_room"}
    furnished = (r.model_copy(update=said[r.id] | apart.get(r.id, {})) for r in program.rooms)
    return program.model_copy(update={"rooms": tuple(furnished), "furniture": own, "evidence": (*program.evidence, *evidence)})


def combine_claims(claims: Sequence[Claim], prompt: str, where: str) -> Furniture:
    """Return the wishes that claims of one room make together. Raises ImpossibleError naming words that clash."""
    counts: dict[str, Things] = {}
    fields: dict[str, Any] = {}

    def narrowed(claim: Claim, least: int, most: int | None, what: str) -> tuple[int, int | None]:
        least, most = max(least, claim.least), min((m for m in (most, claim.most) if m is not None), default=None)
        if most is not None and least > most:
            _clash(f"{where} is to have at least {least} and at most {most} {what}", claims, claim, prompt)
        return least, most

    for claim in claims:
        if claim.kind == "count":
            old = counts.get(claim.name, Things(category=claim.name))
            least, most = narrowed(claim, old.min, old.max, claim.name.removeprefix("any_"))
            counts[claim.name] = Things(category=claim.name, min=least, max=most)
        elif claim.kind == "pieces":
            least, most = narrowed(claim, fields.get("least") or 0, fields.get("most"), "pieces")
            fields |= {"least": least or None, "most": most}
        elif claim.kind == "style":
            if fields.setdefault("style", claim.name) != claim.name:
                _clash(f"{where} is to be both {fields['style']} and {claim.name}", claims, claim, prompt)
        elif claim.kind == "openable":
            fields["openable"] = max(fields.get("openable", 0), claim.least)
        else:
            fields["walkable"] = max(fields.get("walkable", 0.0), claim.value)
    return Furniture.model_validate({**fields, "counts": tuple(counts.values())})


def _clash(message: str, claims: Sequence[Claim], claim: Claim, prompt: str) -> NoReturn:
    both = [c for c in claims if c.kind == claim.kind and (c.name == claim.name or claim.kind != "count")]
    words = [Evidence(start=c.start, end=c.end, text=prompt[c.start : c.end], field="furniture") for c in both]
    raise ImpossibleError(message, "keep one of the two", words)


class _Place:
    """Tells which rooms a claim means."""

    def __init__(self, program: FloorProgram, claims: Sequence[Claim], prompt: str, named: Sequence[Mention]) -> None:
        self.claims, self.prompt, self.named = claims, prompt, named
        self.kinds: Mapping[str, str] = {r.id: r.type for r in program.rooms}
        self.compared = [{r.a, r.b} for r in program.relations if r.kind == "area_order"]
        self.scan = Scan(prompt)
        self.host: tuple[str, ...] = ()
        self.until = -1  # of the last wish that went past the room in front of it, and where it ends
        self.stops = [-1, *(w.start for w in self.scan.words if w.text in STOPS), len(prompt)]

    def _at(self, place: int) -> int:
        """Return the first word from a place on."""
        return bisect.bisect_left([w.start for w in self.scan.words], place)

    def of(self, claim: Claim) -> tuple[str, ...]:  # noqa: PLR0911 - one answer per rule
        """Return the ids of the rooms that a claim means, () for the whole home."""
        claim = self._placed_with(claim)
        place = bisect.bisect_left(self.stops, claim.start)
        begin, end = self.stops[place - 1] + 1, self.stops[place]
        before = [m for m in self.named if begin <= m.start and m.end <= claim.start]
        after = [m for m in self.named if claim.end <= m.start and m.end <= end]
        gap = self.prompt[claim.end : after[0].start] if after else " " * FARTHEST
        # "a bath with a tub in the bedroom"
        nowhere = before and after and all(impossible(self.kinds[i], claim.name) for i in after[0].ids)
        inward = claim.inward and not nowhere and len(gap) < FARTHEST and COMMA.isdisjoint(gap)
        if inside := [m for m in self.named if claim.start <= m.start and m.end <= claim.end]:
            return self._and_in(inside, claim)  # "at least half of the living room must stay free"
        if claim.home or (claim.kind == "style" and not after and not before):
            return ()
        if inward or (len(gap) <= CLOSE and self.scan.length(self._at(claim.end), "of")):  # "带淋浴的卫生间"
            return self._and_in(after, claim)
        if claim.kind == "style":  # a room's where it stands in the room's list of wishes or right before its name
            if before and self._joined(before[-1].end, claim.start) and self._led(before[-1], claim):
                return before[-1].ids
            return after[0].ids if not gap.strip() and after and not self._dwelling(after[0]) else ()
        likely = [m.ids for m in (*reversed(before), *after, *self.named) if self._natural(claim, m)]
        if not before:
            near = after[0].ids if after and len(gap) <= FARTHEST // 2 else ()
            return near if claim.kind != "count" else likely[0] if likely and claim.least else ()
        lead = self.prompt[before[-1].end : min(c.start for c in self.claims if c.start >= before[-1].end)]
        at = self._at(before[-1].end)
        also = self.scan.length(at, "and")  # "larger than the living room and have an oven"
        goes_on = not COMMA.isdisjoint(lead) or (also and self.scan.length(at + also, "with"))
        if len(before) > 1 and goes_on and {*before[-2].ids, *before[-1].ids} in self.compared:
            before = before[:-1]  # "a study smaller than the bedroom, with a desk"
        room, usual = before[-1], self._natural(claim, before[-1])
        if self._dwelling(room) and not (claim.plural and usual):
            return ()  # "a two-bedroom flat with a sofa"; but "with bunk beds"
        joined, barred = self._joined(room.end, claim.start), any(impossible(self.kinds[i], claim.name) for i in room.ids)
        follows = self.until > room.end and self._joined(self.until, claim.start)
        host = self.host if follows and (not usual or any(self.kinds[i] in natural(claim.name) for i in self.host)) else ()
        lead = self.prompt[room.end : claim.start] if barred else lead
        studio = [(i,) for i, kind in self.kinds.items() if kind == "studio_room" and natural(claim.name) != ("kitchen",)]
        if host or ((likely or studio) and not usual and not COMMA.isdisjoint(lead)):
            self.host, self.until = host or (likely or studio)[0], claim.end
            return self.host  # "a studio with a bathroom, put a bed and a desk in it"
        same = [m for m in before if m.ids == room.ids]
        placed = COMMA.isdisjoint(lead) and any(self.scan.fronted(self._at(m.start)) for m in same)  # "in the office put ..."
        if usual or placed or (joined and self._led(room, claim)):
            return room.ids if claim.kind == "count" else self._and_in(before[: before.index(room) + 1][::-1], claim)
        mine = not joined and not barred
        return likely[0] if likely else room.ids if mine else ()  # "two bedrooms, a kitchen and a sofa": the home's

    def _placed_with(self, claim: Claim) -> Claim:
        """Return the wish as far as what follows it with a "with" and says where both are: "a table with four chairs in the kitchen"."""
        at = self._at(claim.end)
        lead = 0 if claim.inward or claim.kind != "count" else self.scan.length(at, "with")
        behind = (c for c in self.claims if lead and c.kind == "count" and c.inward and self._at(c.start) == at + lead)
        return next((replace(claim, end=c.end, inward=True) for c in behind), claim)

    def _and_in(self, after: Sequence[Mention], claim: Claim) -> tuple[str, ...]:
        """Return the rooms of the first mention and of those that go on from it: "in the bedroom and in the study", "bedroom and study both"; in front of a wish they come last first."""
        ids, end = after[0].ids, self._at(claim.end)
        both = claim.kind != "count" and any(self.scan.length(k, "both") for k in range(self._at(after[0].start), end))
        for pair in itertools.pairwise(after):
            k = self._at(min(m.end for m in pair))
            joined = self.scan.text(k) not in COMMAS and self.scan.length(k, "and")
            one = both and all(len(m.ids) == 1 for m in pair)
            if pair[0].ids != pair[1].ids and not (joined and (one or self.scan.length(k + joined, "in"))):
                break
            ids += tuple(i for i in pair[1].ids if i not in ids)
        return ids

    def _dwelling(self, room: Mention) -> bool:
        """Whether a room says how large a home is: "a two-bedroom flat", "un piso de dos dormitorios"."""
        first, behind = self._at(room.start), self._at(room.end)  # "客厅家具" is no home
        lead = next((k for k in range(first - 1, first - 4, -1) if self.scan.length(k, "dwelling", "with", "and")), first)
        return bool(self.scan.length(lead, "dwelling")) or self.scan.length(behind, "dwelling") > self.scan.length(behind, "furnished")

    def _led(self, room: Mention, claim: Claim) -> bool:
        """Whether a word or a token between a room and a wish gives the one to the other: "with", "has", a colon."""
        between = range(self._at(room.end), self._at(claim.start))
        inside = {k for c in self.claims for k in range(self._at(c.start), self._at(c.end))}  # "no bath": it leads to no other wish
        marked = any(self.scan.length(k, "with", "in", "is") or self.scan.text(k) in {":", "("} for k in between if k not in inside)
        return marked or "characters" in self.scan.traits or self.scan.fronted(self._at(room.start))

    def _joined(self, start: int, end: int) -> bool:
        """Whether between two places stands nothing but other wishes and what joins them."""
        k = self._at(start)
        while end - start <= LONGEST_LIST and k < len(self.scan.words) and self.scan.words[k].start < end:
            word = self.scan.words[k]
            inside = any(c.start <= word.start < c.end for c in self.claims)
            step = 1 if inside or word.text in ":(" else self.scan.length(k, "with", "and", "in", "article", "one", "is")
            if not step:
                return False
            k += step
        return end - start <= LONGEST_LIST

    def _natural(self, claim: Claim, mention: Mention) -> bool:
        return claim.kind != "count" or any(self.kinds.get(i) in natural(claim.name) for i in mention.ids)

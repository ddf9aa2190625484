"""The closed vocabulary of the English parser: names of rooms, homes, roles, cues, styles."""

from __future__ import annotations

# Phrase -> (room type, role). Longest phrase wins; plurals are made by `plural`.
ROOMS: dict[str, tuple[str, str]] = {
    "living room": ("living_room", ""), "living area": ("living_room", ""), "living space": ("living_room", ""), "lounge": ("living_room", ""),
    "sitting room": ("living_room", ""), "living": ("living_room", ""), "front room": ("living_room", ""), "parlour": ("living_room", ""), "parlor": ("living_room", ""),
    "salon": ("living_room", ""), "great room": ("living_room", ""), "family room": ("family_room", ""), "den": ("family_room", ""),
    "kitchen": ("kitchen", ""), "kitchenette": ("kitchen", ""), "cooking area": ("kitchen", ""), "cooking space": ("kitchen", ""),
    "dining room": ("dining_room", ""), "dining area": ("dining_room", ""), "dining space": ("dining_room", ""), "dining": ("dining_room", ""), "eating area": ("dining_room", ""),
    "bedroom": ("bedroom", ""), "bed room": ("bedroom", ""), "sleeping room": ("bedroom", ""), "bed": ("bedroom", ""),
    "master bedroom": ("bedroom", "primary"), "main bedroom": ("bedroom", "primary"), "primary bedroom": ("bedroom", "primary"), "principal bedroom": ("bedroom", "primary"),
    "parents' bedroom": ("bedroom", "primary"), "parent's bedroom": ("bedroom", "primary"), "owners' bedroom": ("bedroom", "primary"), "owner's bedroom": ("bedroom", "primary"),
    "parents' room": ("bedroom", "primary"), "parents bedroom": ("bedroom", "primary"), "owners bedroom": ("bedroom", "primary"),
    "guest bedroom": ("bedroom", "guest"), "guest room": ("bedroom", "guest"), "spare bedroom": ("bedroom", "guest"), "spare room": ("bedroom", "guest"),
    "children's room": ("bedroom", "child"), "children's bedroom": ("bedroom", "child"), "child's room": ("bedroom", "child"), "child's bedroom": ("bedroom", "child"),
    "kids' room": ("bedroom", "child"), "kid's room": ("bedroom", "child"), "kids room": ("bedroom", "child"), "kids' bedroom": ("bedroom", "child"), "kids bedroom": ("bedroom", "child"),
    "nursery": ("bedroom", "child"), "children room": ("bedroom", "child"), "childrens room": ("bedroom", "child"),
    "granny's room": ("bedroom", "elder"), "grandparents' bedroom": ("bedroom", "elder"), "carer's room": ("bedroom", "carer"), "maid's room": ("bedroom", "staff"),
    "maid room": ("bedroom", "staff"), "staff room": ("bedroom", "staff"),
    "bathroom": ("bathroom", ""), "bath room": ("bathroom", ""), "bath": ("bathroom", ""), "shower room": ("bathroom", ""), "washroom": ("bathroom", ""),
    "restroom": ("wc", ""), "master bathroom": ("bathroom", "primary"), "master bath": ("bathroom", "primary"), "family bathroom": ("bathroom", "shared"),
    "shared bathroom": ("bathroom", "shared"), "main bathroom": ("bathroom", "shared"), "guest bathroom": ("bathroom", "guest"),
    "en suite bathroom": ("bathroom", "ensuite"), "ensuite bathroom": ("bathroom", "ensuite"), "en suite bath": ("bathroom", "ensuite"), "en suite": ("bathroom", "ensuite"),
    "ensuite": ("bathroom", "ensuite"), "en suite shower room": ("bathroom", "ensuite"), "ensuite shower room": ("bathroom", "ensuite"),
    "wc": ("wc", ""), "toilet": ("wc", ""), "powder room": ("wc", ""), "guest wc": ("wc", ""), "guest toilet": ("wc", ""), "half bath": ("wc", ""), "cloakroom": ("wc", ""),
    "loo": ("wc", ""), "lavatory": ("wc", ""), "water closet": ("wc", ""),
    "hallway": ("hallway", ""), "hall": ("hallway", ""), "corridor": ("hallway", ""), "passage": ("hallway", ""), "passageway": ("hallway", ""), "landing": ("hallway", "landing"),
    "entrance hall": ("entry", ""), "entry hall": ("entry", ""), "entryway": ("entry", ""), "foyer": ("entry", ""), "vestibule": ("entry", ""), "entry": ("entry", ""),
    "lobby": ("entry", ""), "mudroom": ("entry", ""), "reception hall": ("entry", ""), "reception": ("entry", ""), "entrance lobby": ("entry", ""),
    "closet": ("closet", ""), "walk in closet": ("closet", ""), "walk in wardrobe": ("closet", ""), "dressing room": ("closet", ""), "wardrobe": ("closet", ""),
    "dressing area": ("closet", ""), "walk in": ("closet", ""),
    "utility room": ("utility", ""), "utility": ("utility", ""), "laundry": ("utility", ""), "laundry room": ("utility", ""), "washing room": ("utility", ""),
    "storage room": ("storage", ""), "storage": ("storage", ""), "store room": ("storage", ""), "storeroom": ("storage", ""), "pantry": ("storage", ""), "larder": ("storage", ""),
    "box room": ("storage", ""), "store": ("storage", ""), "archive": ("storage", ""),
    "garage": ("garage", ""), "carport": ("garage", ""), "double garage": ("garage", ""),
    "balcony": ("balcony", ""), "terrace": ("balcony", ""), "patio": ("balcony", ""), "loggia": ("balcony", ""), "deck": ("balcony", ""), "veranda": ("balcony", ""), "porch": ("balcony", ""),
    "stairs": ("staircase", ""), "staircase": ("staircase", ""), "stair": ("staircase", ""), "stairway": ("staircase", ""), "stairwell": ("staircase", ""),
    "office": ("office", ""), "home office": ("office", ""), "study": ("office", ""), "work room": ("office", ""), "workroom": ("office", ""), "main office": ("office", "primary"),
    "studio room": ("studio_room", ""), "main room": ("studio_room", ""), "bed and living area": ("studio_room", ""), "bed and living room": ("studio_room", ""),
    "living and sleeping area": ("studio_room", ""), "living and sleeping room": ("studio_room", ""), "bed sitting room": ("studio_room", ""), "bedsit": ("studio_room", ""),
    "living and bed room": ("studio_room", ""), "sleeping and living area": ("studio_room", ""), "living sleeping room": ("studio_room", ""),
    "media room": ("media_room", ""), "home cinema": ("media_room", ""), "home theatre": ("media_room", ""), "home theater": ("media_room", ""), "tv room": ("media_room", ""),
    "cinema": ("media_room", ""), "cinema room": ("media_room", ""), "gym": ("gym", ""), "fitness room": ("gym", ""), "home gym": ("gym", ""), "library": ("library", ""),
    "reading room": ("library", ""), "playroom": ("playroom", ""), "play room": ("playroom", ""), "games room": ("playroom", ""), "meeting room": ("meeting_room", ""),
    "conference room": ("meeting_room", ""), "workshop": ("workshop", ""), "hobby room": ("workshop", ""), "atelier": ("workshop", ""), "sunroom": ("sunroom", ""),
    "sun room": ("sunroom", ""), "conservatory": ("sunroom", ""), "winter garden": ("sunroom", ""),
}  # fmt: skip
SUITES = {"master suite": "primary", "primary suite": "primary", "guest suite": "guest", "owners' suite": "primary", "owner's suite": "primary", "suite": "", "bedroom suite": ""}  # fmt: skip
IRREGULAR = {"wc": "wcs", "stairs": "stairs", "storage": "storages", "en suite": "en suites", "dining": "dining", "living": "living", "store": "stores", "utility": "utilities"}  # fmt: skip
HOMES = frozenset(
    [
        "apartment",
        "flat",
        "house",
        "home",
        "loft",
        "townhouse",
        "penthouse",
        "unit",
        "villa",
        "bungalow",
        "maisonette",
        "condo",
        "condominium",
        "duplex",
        "residence",
        "dwelling",
        "place",
        "cottage",
        "efficiency",
        "pad",
    ]
)
ADJECTIVES: dict[str, str] = {
    "master": "primary", "main": "primary", "primary": "primary", "principal": "primary", "guest": "guest", "parents'": "primary", "parents": "primary", "owners'": "primary", "owner's": "primary",
    "children's": "child", "kids'": "child", "kids": "child", "largest": "primary", "biggest": "primary",
}  # fmt: skip
OWNERS: dict[str, str] = {
    "grandparents": "elder", "grandparent": "elder", "grandmother": "elder", "grandma": "elder", "granny": "elder", "parents": "primary", "owners": "primary", "couple": "primary", "guests": "guest", "carer": "carer",
    "au": "staff", "staff": "staff",
}  # fmt: skip
NUMBERS = {
    "a": 1, "an": 1, "one": 1, "single": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8, "nine": 9, "ten": 10, "eleven": 11, "twelve": 12,
    "thirteen": 13, "fourteen": 14, "fifteen": 15, "sixteen": 16, "seventeen": 17, "eighteen": 18, "nineteen": 19, "twenty": 20, "thirty": 30, "forty": 40, "fifty": 50, "sixty": 60,
    "seventy": 70, "eighty": 80, "ninety": 90, "hundred": 100, "thousand": 1000, "couple": 2, "dozen": 12, "twin": 2, "double": 2, "half": 0.5,
}  # fmt: skip
ORDINALS = {"first": 1, "second": 2, "third": 3, "fourth": 4, "fifth": 5}
# Relation cues between what stands before and what stands after.
DOOR, OPEN, NEAR, WALL, AWAY, BAN, LEADS, BETWEEN, ENSUITE, THROUGH, MERGE, HAS = (
    "door", "open", "near", "wall", "away", "ban", "leads", "between", "ensuite", "through", "merge", "has",
)  # fmt: skip
CUES: dict[str, str] = {
    **dict.fromkeys(
        ["off", "directly off", "opening off", "open off", "opens off", "opening directly off", "opens directly off", "all open off", "come off", "comes off", "leading off", "accessed from", "accessed through",
         "entered from", "entered through", "entered via", "entered only from", "entered only through", "reached from", "reached through", "reached via", "reachable from", "accessible from", "accessible through", "around", "directly from",
         "opens straight off", "opening straight off", "branching off", "branch off", "that opens off", "opening from", "opens from", "on", "along", "attached to", "connected to", "connected with", "connects to", "connects with", "connecting to",
         "linked to", "go up from", "goes up from", "rise from", "rises from", "with a door to", "has a door to", "door to", "second door to", "with access to", "has access to", "access to", "access from", "with access from", "direct access to",
         "direct access from", "with direct access to", "joined to", "hang off", "hangs off", "reached only from", "reached only through", "only from", "accessible only from", "accessible only through", "exit to", "walks out to", "walk out to"], DOOR),
    **dict.fromkeys(
        ["opens into", "opens onto", "opens on to", "opens to", "opening into", "opening onto", "opening to", "open onto", "leads to", "leads into", "leads on to", "leads onto", "lead to", "lead into", "leading to", "leading into", "lead on to",
         "gives onto", "giving onto", "gives access to", "get into", "get to", "go into", "goes into", "on to", "through to", "connecting", "connects", "serves", "serving", "linking", "links", "joining", "distributes to", "gives on to"], LEADS),
    **dict.fromkeys(["open to", "is open to", "wide open to", "flows into", "flow into", "flowing into", "open towards", "open toward", "merges into", "merging into", "merges with", "blends into", "combined with", "open plan with", "open plan to"], OPEN),
    **dict.fromkeys(["next to", "right next to", "directly next to", "beside", "adjacent to", "adjoining", "adjoins", "alongside", "near", "close to", "by", "neighbouring", "neighboring", "bordering", "right by", "directly beside"], NEAR),
    **dict.fromkeys(["share a wall with", "shares a wall with", "sharing a wall with", "share one wall with", "wall to wall with", "back to back with", "touching", "touches", "touch"], WALL),
    **dict.fromkeys(
        ["away from", "well away from", "far from", "far away from", "separated from", "clearly separated from", "clear of", "distant from", "at a distance from", "remote from", "at the other end from", "on the opposite side from", "isolated from"], AWAY),
    **dict.fromkeys(
        ["not next to", "not adjacent to", "not beside", "not share a wall with", "not border", "not bordering", "not touching", "not touch", "not near", "not close to", "not by", "not adjoining", "never next to", "not directly next to", "not right next to"], BAN),
    **dict.fromkeys(["between", "sits between", "in between", "lies between", "placed between"], BETWEEN),
    **dict.fromkeys(["en suite to", "ensuite to", "private to"], ENSUITE),
    **dict.fromkeys(
        ["without walking through", "without passing through", "without going through", "without crossing", "without having to walk through", "without having to go through", "not through", "rather than through", "without entering", "without passing"], THROUGH),
    **dict.fromkeys(["with", "has", "have", "having", "including", "includes", "gets", "get", "comes with", "featuring", "plus", "and has", "have got"], HAS),
}  # fmt: skip
UNITS = {  # phrase -> (quantity, factor to m2 or m)
    "m²": ("area", 1.0), "m2": ("area", 1.0), "sqm": ("area", 1.0), "sq m": ("area", 1.0), "sq metres": ("area", 1.0), "sq meters": ("area", 1.0), "square metres": ("area", 1.0), "square meters": ("area", 1.0), "square metre": ("area", 1.0),
    "square meter": ("area", 1.0), "square m": ("area", 1.0), "qm": ("area", 1.0), "sqm.": ("area", 1.0), "sq mtr": ("area", 1.0), "metres squared": ("area", 1.0), "meters squared": ("area", 1.0),
    "sq ft": ("area", 0.092903), "sqft": ("area", 0.092903), "square feet": ("area", 0.092903), "square foot": ("area", 0.092903), "sf": ("area", 0.092903), "ft²": ("area", 0.092903), "sq feet": ("area", 0.092903), "sq . ft": ("area", 0.092903),
    "m": ("length", 1.0), "metres": ("length", 1.0), "meters": ("length", 1.0), "metre": ("length", 1.0), "meter": ("length", 1.0), "cm": ("length", 0.01), "centimetres": ("length", 0.01), "centimeters": ("length", 0.01),
    "mm": ("length", 0.001), "ft": ("length", 0.3048), "feet": ("length", 0.3048), "foot": ("length", 0.3048), "inches": ("length", 0.0254), "inch": ("length", 0.0254),
    "%": ("share", 0.01), "percent": ("share", 0.01), "per cent": ("share", 0.01), "pieces of furniture": ("pieces", 1.0), "pieces": ("pieces", 1.0), "objects": ("pieces", 1.0), "furniture pieces": ("pieces", 1.0), "items": ("pieces", 1.0),
    "items of furniture": ("pieces", 1.0), "furnishings": ("pieces", 1.0), "storeys": ("storeys", 1.0), "stories": ("storeys", 1.0), "storey": ("storeys", 1.0), "story": ("storeys", 1.0), "floors": ("storeys", 1.0), "floor": ("storeys", 1.0),
    "levels": ("storeys", 1.0), "level": ("storeys", 1.0), "rooms": ("rooms", 1.0), "room": ("rooms", 1.0),
}  # fmt: skip
LEAST = frozenset(["at least", "minimum", "min", "minimum of", "a minimum of", "over", "more than", "no less than", "not less than", "from", "above", "upwards of", "no smaller than", "not smaller than", ">=", "no narrower than", "bigger than", "larger than"])  # fmt: skip
MOST = frozenset(["at most", "maximum", "max", "maximum of", "under", "less than", "up to", "below", "no more than", "not more than", "no larger than", "no bigger than", "not exceeding", "within"])  # fmt: skip
ABOUT = frozenset(["about", "around", "roughly", "approximately", "approx", "circa", "ca", "some", "nearly", "almost", "~", "c", "of", "in total", "total", "totalling", "measuring", "with"])  # fmt: skip
OR_MORE = frozenset(["or more", "or larger", "or bigger", "minimum", "or above", "at least", "or wider", "+", "plus", "and up", "min"])
OR_LESS = frozenset(["or less", "or smaller", "maximum", "or under", "at most", "max", "tops"])
_STYLES: tuple[tuple[tuple[str, ...], dict[str, int]], ...] = (
    (("square", "squarish", "boxy", "regular shapes", "no long thin rooms", "well proportioned"), {"squareness": 2, "simplicity": 1}),
    (("irregular", "organic", "unconventional", "non rectangular", "unusual shapes", "not a grid", "grid of boxes"), {"squareness": -3, "simplicity": -3, "convexity": -2}),
    (("bright", "airy", "daylight", "panoramic", "corner windows", "sunny", "light filled", "lots of light"), {"exterior": 3, "corner_light": 3, "squareness": -1}),
    (("compact", "efficient", "no wasted", "space saving"), {"useful_area": 3, "circulation": 1}),
    (("direct", "short walks", "short distances"), {"circulation": 2}),
    (("aligned walls", "simple structure", "cheap to build", "simple rectangular outline", "simple rectangular"), {"alignment": 3, "simplicity": 2}),
    (("wheelchair", "rollator", "step free", "barrier free", "accessible", "no steps"), {"min_width": 2}),
)  # fmt: skip
STYLES: dict[str, dict[str, int]] = {word: knobs for words, knobs in _STYLES for word in words}
IRREGULAR_WORDS = frozenset(["irregular", "organic", "unconventional", "non rectangular", "not a grid", "grid of boxes"])
BIG = {"huge": 1.5, "very large": 1.5, "enormous": 1.6, "vast": 1.6, "large": 1.35, "big": 1.3, "generous": 1.35, "spacious": 1.35, "roomy": 1.2, "spa like": 1.5, "small": 0.75, "tiny": 0.6, "little": 0.8, "compact": 0.8, "cosy": 0.85, "cozy": 0.85, "short": 0.9, "galley": 0.7}  # fmt: skip
# Words that carry no request: understood without effect.
FILLER = frozenset(
    ["i", "i'd", "i'm", "i've", "need", "want", "like", "would", "please", "design", "make", "build", "create", "draw", "generate", "give", "me", "us", "we", "with", "and", "or", "the", "a", "an", "of", "for", "to", "in", "at", "on", "by", "is", "are", "be", "been", "being", "that", "this", "these", "those", "there's", "there", "it", "its", "it's", "their", "they", "them", "you", "your", "our", "my", "his", "her", "he", "she", "who", "which", "where", "when", "as", "than", "then", "so", "but", "too", "also", "just", "only", "all", "both", "each", "every", "one", "ones", "any", "some", "other", "another", "same", "own", "has", "have", "had", "having", "do", "does", "should", "must", "can", "could", "will", "shall", "may", "might", "if", "from", "into", "onto", "through", "over", "under", "up", "down", "out", "off", "between", "per", "about", "around", "roughly", "approximately", "approx", "very", "quite", "really", "rather", "nice", "classic", "basic", "proper", "typical", "standard", "simple", "modern", "nordic", "normal", "separate", "private", "shared", "common", "family", "formal", "main", "second", "third", "side", "end", "middle", "center", "centre", "central", "front", "back", "left", "right", "apart", "together", "plus", "no", "not", "without", "nothing", "else", "none", "more", "less", "than", "least", "most", "at", "well", "clearly", "come", "comes", "go", "goes", "get", "gets", "lead", "leads", "open", "opens", "opening", "sit", "sits", "lie", "lies", "share", "shares", "put", "place", "placed", "located", "belong", "belongs", "work", "works", "works", "home", "house", "flat", "here", "there", "everything", "anything", "room", "rooms", "area", "areas", "space", "spaces", "size", "sized", "kind", "type", "style", "layout", "plan", "floor", "storey", "story", "level", "levels", "floors", "single", "one", "two", "door", "doors", "window", "windows", "wall", "walls", "outside", "inside", "outdoor", "exterior", "outline", "front", "enough", "big", "large", "small", "little", "tiny", "huge", "generous", "spacious", "good", "great", "possible", "possibly", "ideally", "preferably", "maybe", "perhaps", "clients", "client", "visitors", "people", "persons", "person", "couple", "couples", "family", "kids", "children", "child", "parents", "guest", "guests", "owner", "owners", "grandparents", "generations", "user", "student", "friends", "sharing", "table", "desk", "desks", "desks", "two", "eat", "eat-in", "in", "movie", "nights", "night", "parties", "party", "made", "built", "files", "meeting", "small", "reach", "reached", "reachable", "entered", "enter", "entering", "use", "used", "using", "feel", "feels", "shouldn't", "doesn't", "don't", "won't", "needed", "wanted", "required", "s", "t", "life", "living", "cook", "cooking", "sleeping", "sleep", "dining", "work", "working", "let's", "called", "it's", "type's", "roof", "under", "three", "access", "direct", "directly", "straight", "short", "long", "wide", "narrow", "narrower", "wider", "larger", "bigger", "smaller", "similar", "equal", "equally", "equals", "times", "half", "twice", "size", "much", "many", "lot", "lots", "bit", "of", "cm", "m", "mm", "daylight", "natural", "light", "quiet", "shut", "shutting", "closed", "close", "near", "next", "beside", "away", "far", "opposite", "end", "buffer", "zone", "zones", "side", "sides", "way", "total", "overall", "including", "include", "includes", "such", "however", "while", "because", "since", "around", "stick", "connected", "connect", "connects", "downstairs", "upstairs", "ground", "first", "upper", "lower", "stairs", "steps", "step", "free", "also", "galley", "nook", "eat", "one's", "ones'", "guest's", "chef's", "chef", "walk", "walking", "walks", "passing", "going", "without", "welcome", "proportions", "shapes", "unusual", "irregular", "grid", "boxes", "box", "panoramic", "glazing", "glazed", "wraparound", "spa-like", "spa", "like", "airy", "luxury", "combined", "unit", "efficiency", "very", "compact", "rectangular", "wasted", "corridor", "wheelchair", "carer", "carer's", "now", "hi", "hello", "thanks", "thank", "dear", "needs", "wants", "wish", "wishes", "someone", "somebody", "anyone", "able", "likes", "love", "prefer", "preferred", "prefers", "plenty", "main-floor", "owned", "rent", "budget", "new", "old", "young", "retired", "student's"]
)  # fmt: skip


def plural(phrase: str) -> str:
    """Return the plural of a phrase: that of its last word."""
    if phrase in IRREGULAR:
        return IRREGULAR[phrase]
    head, _, last = phrase.rpartition(" ")
    if last.endswith("y") and last[-2] not in "aeiou":
        last = last[:-1] + "ies"
    elif last.endswith(("s", "ch", "sh", "x")):
        last += "es"
    else:
        last += "s"
    return f"{head} {last}".strip()

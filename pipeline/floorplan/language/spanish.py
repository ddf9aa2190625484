"""Spanish verbs: the forms that a description uses, told from their infinitives, and the one form of each that the lexicon knows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from pipeline.floorplan.language.text import fold

# stem of the present, of the subjunctive, of the future, of the preterite; "" where it is regular
IRREGULAR = {
    "tener": ("tien", "teng", "tendr", "tuv"), "contener": ("contien", "conteng", "contendr", "contuv"), "poder": ("pued", "pued", "podr", "pud"),
    "querer": ("quier", "quier", "querr", "quis"), "poner": ("", "pong", "pondr", "pus"), "disponer": ("", "dispong", "dispondr", "dispus"),
    "componer": ("", "compong", "compondr", "compus"), "salir": ("", "salg", "saldr", ""), "venir": ("vien", "veng", "vendr", "vin"),
    "hacer": ("", "hag", "har", "hic"), "caber": ("", "quep", "cabr", "cup"), "seguir": ("sigu", "sig", "", ""), "pedir": ("pid", "pid", "", "pid"),
    "servir": ("sirv", "sirv", "", "sirv"), "medir": ("mid", "mid", "", "mid"), "contar": ("cuent", "cuent", "", ""),
    "encontrar": ("encuentr", "encuentr", "", ""), "preferir": ("prefier", "prefier", "", ""), "conducir": ("", "conduzc", "", "conduj"),
    "incluir": ("incluy", "incluy", "", "incluy"), "distribuir": ("distribuy", "distribuy", "", "distribuy"), "morir": ("muer", "muer", "", ""),
    "construir": ("construy", "construy", "", "construy"), "sustituir": ("sustituy", "sustituy", "", ""), "cerrar": ("cierr", "cierr", "", ""),
    "dormir": ("duerm", "duerm", "", "durm"), "pertenecer": ("", "pertenezc", "", ""), "ofrecer": ("", "ofrezc", "", ""),
    "aparecer": ("", "aparezc", "", ""), "extender": ("extiend", "extiend", "", ""), "colgar": ("cuelg", "cuelg", "", ""),
    "reunir": ("reún", "reún", "", ""), "recaer": ("", "recaig", "", ""), "soñar": ("sueñ", "sueñ", "", ""), "haber": ("ha", "hay", "habr", "hub"),
    "convertir": ("conviert", "conviert", "", ""), "decir": ("dic", "dig", "dir", "dij"), "ver": ("v", "ve", "ver", "v"),
}  # fmt: skip
ODD = {  # of the third person, singular and plural: present | other tenses
    "ser": ("es son", "sea sean era eran será serán sería serían"),
    "estar": ("está están", "estén estaba estaban estará estarán estaría estarían estuviera estuvieran estuviese estuviesen"),
    "ir": ("va van", "vaya vayan iba iban irá irán iría irían"),
    "dar": ("da dan", "den daba daban dará darán daría darían diera dieran diese diesen"),
    "haber": ("hay hay", "haya hayan había habían habrá habrán habría habrían hubiera hubieran"),
}
SOFT = {"c": "qu", "g": "gu", "z": "c"}  # in front of an e
TWOFOLD = {
    "entre", "sobre", "de", "este", "esta", "fuera", "cuente", "pase", "parte", "come", "cocine", "sala", "salas", "una", "unas", "hacia", "hacian", "media",
    "aparte", "via", "sirva", "sede", "lave", "vela",
}  # fmt: skip # other words too


def present(infinitive: str) -> tuple[str, str]:
    """Return the third persons of the present: "abre", "abren"."""
    if infinitive in ODD:
        one, many = ODD[infinitive][0].split()
        return one, many
    stem = IRREGULAR.get(infinitive, ("",) * 4)[0] or infinitive[:-2]
    vowel = "a" if infinitive.endswith("ar") else "e"
    return stem + vowel, stem + vowel + "n"


def tenses(infinitive: str) -> Iterator[tuple[str, str]]:
    """Return (form, form of the present) of the third persons: "abrirán", "abren"; of "we" and "I would": as they are."""
    one, many = present(infinitive)
    if infinitive in ODD:
        for form in ODD[infinitive][1].split():
            yield form, many if form.endswith("n") else one
        return
    kind, stem = infinitive[-2:], infinitive[:-2]
    _, wish, future, past = IRREGULAR.get(infinitive, ("",) * 4)
    wish = wish or one[:-1]
    last = wish[-1]
    wish = wish[:-1] + (SOFT.get(last, last) if kind == "ar" else {"g": "j"}.get(last, last) if not IRREGULAR.get(infinitive) else last)
    made = [wish + ("e" if kind == "ar" else "a")]
    made += [(future or infinitive) + end for end in ("á", "ía")]
    made += [stem + end for end in (("aba", "ara", "ase") if kind == "ar" else ("ía",))]
    made += [] if kind == "ar" else [(past or stem) + end.removeprefix("i" if past.endswith("j") else "-") for end in ("iera", "iese")]
    for form in made:
        yield form, one
        yield form + "n", many


def canonical(infinitives: Iterable[str]) -> dict[str, str]:
    """Return folded form -> folded form of the present, for every tense of these verbs; words that mean something else besides are left out."""
    made: dict[str, str] = {}
    for verb in infinitives:
        for form, shown in tenses(verb):
            word = fold(form)
            if word not in TWOFOLD and word != fold(shown):
                made.setdefault(word, fold(shown))
    return made


def further(infinitive: str) -> Iterator[str]:
    """Return the gerund, the participles and the forms of "we" and "I", which are only known not to be errors."""
    stem, kind = infinitive[:-2], infinitive[-2:]
    yield stem + ("ando" if kind == "ar" else "iendo")
    yield from (stem + ("ad" if kind == "ar" else "id") + end for end in ("o", "a", "os", "as"))
    yield from (present(infinitive)[0][:-1] + "o", stem + {"ar": "amos", "er": "emos", "ir": "imos"}.get(kind, "imos"))
    yield from (infinitive + end for end in ("emos", "íamos", "se", "lo", "la", "los", "las"))
    yield stem + ("ábamos" if kind == "ar" else "íamos")


def conjugated(phrase: str) -> Iterator[str]:
    """Return "dar a" as "dar a", "da a", "da al", "se da a", "dan al" ...: the forms that are left, "a" and "de" with their article too."""
    verb, _, rest = phrase.partition(" ")
    if not verb.endswith(("ar", "er", "ir", "ír")):  # "conectado con": of one or many, of both genders
        head = next((w for w in phrase.split() if w.endswith("o") and len(w) > 4), "")
        alike = [head[:-1] + end for end in ("o", "a", "os", "as")] if head else [""]
        for form in alike:
            said = phrase.replace(head, form, 1) if head else phrase
            yield from (said, said + "l") if said.split(" ")[-1] in {"a", "de"} else (said,)
        if head == "" and verb.endswith("e"):
            yield from conjugated(phrase.replace(verb, verb + "s", 1))
        return
    ends = [rest, rest + "l"] if rest.split(" ")[-1] in {"a", "de"} else [rest]
    for form in (verb, *present(verb)):
        for end in ends:
            yield f"{form} {end}".strip()
            yield (f"{form}se {end}" if form == verb else f"se {form} {end}").strip()

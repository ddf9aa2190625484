"""German ways in breadth: many sentences for one fact about two rooms, each read as that fact and no more."""

import pytest

from pipeline.floorplan import parse

REST = "Zwei Schlafzimmer, ein Bad. "
JOINED = [
    "Das Büro führt in die Küche.",
    "Vom Büro führt eine Tür in die Küche.",
    "Vom Büro aus geht es in die Küche.",
    "Aus dem Büro gelangt man in die Küche.",
    "Aus dem Büro kommt man direkt in die Küche.",
    "Das Büro hat einen Zugang zur Küche.",
    "Das Büro hat einen direkten Durchgang zur Küche.",
    "Das Büro mit Durchgang zur Küche.",
    "Das Büro verfügt über einen Zugang zur Küche.",
    "Das Büro besitzt eine Tür zur Küche.",
    "Ein Büro mit Tür in die Küche.",
    "Ein Büro mit direkter Verbindung zur Küche.",
    "Das Büro ist von der Küche aus erreichbar.",
    "Das Büro ist über die Küche zu erreichen.",
    "Das Büro ist über die Küche zugänglich.",
    "Das Büro wird über die Küche erschlossen.",
    "Das Büro wird von der Küche aus betreten.",
    "Das Büro betritt man von der Küche aus.",
    "Man betritt das Büro von der Küche aus.",
    "Man erreicht das Büro über die Küche.",
    "Das Büro erreicht man durch die Küche.",
    "Ins Büro kommt man durch die Küche.",
    "Zum Büro gelangt man über die Küche.",
    "Der Zugang zum Büro erfolgt über die Küche.",
    "Der Zugang zum Büro ist von der Küche.",
    "Das Büro geht von der Küche ab.",
    "Von der Küche geht das Büro ab.",
    "Von der Küche zweigt das Büro ab.",
    "Von der Küche führt eine Tür ins Büro.",
    "Von der Küche aus erreicht man das Büro.",
    "Durch die Küche gelangt man ins Büro.",
    "Über die Küche kommt man ins Büro.",
    "Hinter der Küche liegt das Büro.",
    "Hinter der Küche befindet sich das Büro.",
    "Das Büro liegt hinter der Küche.",
    "Das Büro ist mit der Küche verbunden.",
    "Büro und Küche sind verbunden.",
    "Büro und Küche sind miteinander verbunden.",
    "Büro und Küche sind durch eine Tür verbunden.",
    "Zwischen Büro und Küche gibt es eine Tür.",
    "Zwischen Büro und Küche soll eine Tür sein.",
    "Büro und Küche haben eine Verbindungstür.",
    "Eine Tür verbindet Büro und Küche.",
    "Das Büro schließt an die Küche an.",
    "An die Küche schließt das Büro an.",
    "An die Küche schließt sich das Büro an.",
    "Das Büro schließt sich an die Küche an.",
    "Das Büro ist an die Küche angeschlossen.",
    "Das Büro ist an die Küche angebunden.",
    "Der Küche ist das Büro angegliedert.",
    "Die Küche führt zum Büro.",
    "Das Büro öffnet sich zur Küche.",
    "Das Büro, das von der Küche abgeht, ist klein.",
    "Das Büro, das man über die Küche erreicht, ist klein.",
    "Das Büro, das nur von der Küche aus zugänglich ist.",
    "Ein Büro, von dem aus man in die Küche kommt.",
    "Eine Küche, von der das Büro abgeht.",
    "Eine Küche, über die man ins Büro gelangt.",
    "Eine Küche mit angeschlossenem Büro.",
    "Eine Küche mit angrenzendem Büro.",
    "Ein an die Küche angrenzendes Büro.",
    "Ein von der Küche erreichbares Büro.",
    "Das Büro hängt an der Küche.",
    "Das Büro liegt an der Küche.",
    "Das Büro liegt neben der Küche.",
    "Das Büro befindet sich neben der Küche.",
    "Neben der Küche liegt das Büro.",
    "Neben der Küche ein Büro.",
    "Das Büro grenzt an die Küche.",
    "Das Büro grenzt direkt an die Küche an.",
    "Das Büro soll an die Küche grenzen.",
    "Büro neben Küche.",
    "Büro direkt bei der Küche.",
    "Das Büro ist der Küche benachbart.",
    "Das Büro liegt in der Nähe der Küche.",
    "Das Büro liegt unmittelbar neben der Küche.",
    "Büro und Küche liegen nebeneinander.",
    "Büro und Küche sollen nebeneinander liegen.",
    "Büro und Küche grenzen aneinander.",
    "Das Büro liegt gegenüber der Küche.",
    "Küche, daneben das Büro.",
    "Küche, daran anschließend das Büro.",
    "Küche mit Zugang zum Büro.",
    "Küche (Zugang zum Büro).",
    "Büro (von der Küche aus).",
    "Büro - Zugang über Küche.",
    "Man geht durch die Küche ins Büro.",
    "Man muss durch die Küche gehen, um ins Büro zu kommen.",
    "Wer ins Büro will, muss durch die Küche.",
    "Direkt neben der Küche soll sich das Büro befinden.",
    "In der Küche gibt es eine Tür zum Büro.",
    "Die Küche soll einen direkten Zugang zum Büro haben.",
    "Die Küche soll direkt ins Büro führen.",
    "Das Büro soll direkt von der Küche abgehen.",
    "Das Büro soll an der Küche liegen.",
    "Wichtig ist, dass das Büro neben der Küche liegt.",
    "Schön wäre, wenn das Büro direkt an die Küche grenzt.",
    "Uns ist wichtig, dass man vom Büro direkt in die Küche kommt.",
]
OPEN = [
    "Die Küche ist zum Wohnzimmer offen.",
    "Die Küche ist zum Wohnzimmer hin offen.",
    "Die Küche soll zum Wohnzimmer hin offen sein.",
    "Die offene Küche geht ins Wohnzimmer über.",
    "Die Küche geht offen ins Wohnzimmer über.",
    "Küche und Wohnzimmer gehen ineinander über.",
    "Küche und Wohnzimmer sind offen.",
    "Küche und Wohnzimmer offen gestaltet.",
    "Wohnzimmer mit offener Küche.",
    "Offene Küche zum Wohnzimmer.",
    "Küche und Wohnzimmer bilden eine Einheit.",
    "Küche und Wohnzimmer in einem Raum.",
    "Küche und Wohnzimmer sind ein Raum.",
    "Die Küche ist in das Wohnzimmer integriert.",
    "Wohnzimmer mit integrierter Küche.",
    "Keine Wand zwischen Küche und Wohnzimmer.",
    "Zwischen Küche und Wohnzimmer soll keine Wand sein.",
    "Küche und Wohnzimmer ohne Trennwand.",
    "Die Küche bildet mit dem Wohnzimmer einen offenen Raum.",
    "Die Küche ist offen mit dem Wohnzimmer verbunden.",
    "Wohnzimmer und Küche offen verbunden.",
    "Ein offener Wohnbereich mit Küche.",
    "Eine zum Wohnzimmer offene Küche.",
    "Die zum Wohnzimmer hin offene Küche ist klein.",
    "Die Küche, die zum Wohnzimmer offen ist, ist klein.",
    "Wohnzimmer, offene Küche.",
    "Das Wohnzimmer mit der offenen Küche hat 30 m².",
    "Die Küche soll offen ins Wohnzimmer übergehen.",
]
APART = [
    "Das Büro darf nicht an die Küche grenzen.",
    "Das Büro soll nicht neben der Küche liegen.",
    "Büro nicht neben der Küche.",
    "Büro und Küche sollen nicht nebeneinander liegen.",
    "Büro und Küche dürfen nicht aneinander grenzen.",
    "Büro und Küche dürfen keine gemeinsame Wand haben.",
    "Das Büro soll weit weg von der Küche liegen.",
    "Das Büro liegt möglichst weit von der Küche entfernt.",
    "Büro weit weg von der Küche.",
    "Das Büro soll keine Wand mit der Küche teilen.",
    "Auf keinen Fall soll das Büro neben der Küche liegen.",
    "Bitte kein Büro neben der Küche.",
    "Das Büro soll von der Küche entfernt sein.",
    "Büro und Küche sollen weit voneinander entfernt sein.",
    "Das Büro darf nicht direkt neben der Küche sein.",
    "Ich möchte nicht, dass das Büro neben der Küche liegt.",
    "Das Büro soll abseits der Küche liegen.",
    "Das Büro sollte nicht an der Küche liegen.",
]
NO_DOOR = [
    "Keine Tür zwischen Büro und Küche.",
    "Büro und Küche sollen nicht verbunden sein.",
    "Das Büro darf keine Tür zur Küche haben.",
    "Es soll keine direkte Verbindung zwischen Büro und Küche geben.",
    "Das Büro soll nicht von der Küche aus zugänglich sein.",
    "Das Büro soll keinen Zugang zur Küche haben.",
    "Kein Zugang von der Küche zum Büro.",
    "Zwischen Büro und Küche darf es keine Tür geben.",
]


def facts(sentence, *pair):
    """Return the kinds of the links that a sentence states between two types, all its links, and what is forbidden between the two."""
    program = parse(REST + sentence)
    kinds = {r.id: r.type for r in program.rooms}
    assert sorted(r.type for r in program.rooms if r.stated) == sorted(["bathroom", "bedroom", "bedroom", *pair])
    links = [({kinds[k.a], kinds[k.b]}, k.kind) for k in program.links if k.stated]
    banned = {f.what for f in program.forbids if {kinds.get(f.a), kinds.get(f.b or f.avoid or "")} == set(pair)}
    return [kind for rooms, kind in links if rooms == set(pair)], len(links), banned


@pytest.mark.parametrize("sentence", JOINED)
def test_two_rooms_are_joined(sentence):
    kinds, count, banned = facts(sentence, "kitchen", "office")
    assert (len(kinds), count, banned) == (1, 1, set())


@pytest.mark.parametrize("sentence", OPEN)
def test_two_rooms_are_open_to_each_other(sentence):
    kinds, count, _ = facts(sentence, "kitchen", "living_room")
    assert (kinds, count) == (["open"], 1)


@pytest.mark.parametrize("sentence", APART)
def test_two_rooms_keep_apart(sentence):
    _, count, banned = facts(sentence, "kitchen", "office")
    assert not count
    assert "adjacent" in banned


@pytest.mark.parametrize("sentence", NO_DOOR)
def test_two_rooms_have_no_door(sentence):
    _, count, banned = facts(sentence, "kitchen", "office")
    assert not count
    assert banned & {"connected", "through"}

import numpy as np
import pytest

from pipeline import seeds
from pipeline.errors import ContentError
from pipeline.retrieval.index import AssetIndex, RetrievalSettings
from pipeline.retrieval.taste import Taste, tasteful

SHELVES = {"cabinet": 30, "dining_chair": 12, "bathtub": 1}


def tables(seed=0):
    rng = seeds.generator(seed, "assets")
    assets, latents, joints = [], [], []
    for category, count in SHELVES.items():
        for i in range(count):
            name = f"{category}_{i:02d}"
            opens = category == "cabinet" and i % 2 == 0
            size = rng.uniform(0.4, 2.0, 3)
            assets.append(
                {"asset_id": name, "category": category, "split": "train", "size": size.tolist(), "articulated": opens, "openable": opens}
            )
            latents.append({"asset_id": name, "latent": rng.normal(0, 1, 32).tolist()})
            if opens:
                w, d, h = size
                joints += [
                    {"asset_id": name, "sweep_min": [-w / 2, -d / 2 - 0.4, k * h / 6], "sweep_max": [w / 2, -d / 2, (k + 1) * h / 6]}
                    for k in range(6)
                ]
    return assets, latents, joints


@pytest.fixture(scope="module")
def index():
    return AssetIndex.from_tables(*tables())


def matches(index, categories, sizes, latents):
    """What is nearest, whatever it looks like."""
    return tasteful(index, Taste(), categories, sizes, latents, np.zeros((len(categories), 3)))


def asks(index, rows):
    raw = index.latents[rows] * index.spread + index.mean
    return [index.categories[r] for r in rows], index.sizes[rows], raw


def test_an_asset_that_is_asked_for_exactly_is_found(index):
    rows = np.flatnonzero(index.openable | (np.array(index.categories) != "cabinet"))
    for match, row in zip(matches(index, *asks(index, rows)), rows, strict=True):
        assert match.asset_id == index.asset_ids[row]
        assert match.distance == pytest.approx(0, abs=1e-9)
        np.testing.assert_allclose(match.scale, 1)
        np.testing.assert_allclose(match.size, index.sizes[row])


def distances(index, shelf, size, latent):
    """How far the assets of a shelf are from one ask, by the formula."""
    shape = np.sqrt((((latent - index.mean) / index.spread - index.latents[shelf]) ** 2).mean(-1))
    ratio = np.sqrt((np.log(size / index.sizes[shelf]) ** 2).mean(-1))
    far = 0.3 * shape + 2.0 * ratio
    openable = index.openable[shelf]
    return np.where(openable, far, (far + 0.15) * 1.5) if openable.any() else far


def test_matches_are_of_the_category_and_nearest(index):
    rng = seeds.generator(1, "asks")
    categories = [str(c) for c in rng.choice(list(SHELVES), 50)]
    sizes, latents = rng.uniform(0.3, 2.2, (50, 3)), rng.normal(0, 1, (50, 32))
    for p, match in enumerate(matches(index, categories, sizes, latents)):
        shelf = index.shelves[categories[p]]
        assert index.categories[index.row(match.asset_id)] == categories[p]
        assert match.distance == pytest.approx(distances(index, shelf, sizes[p], latents[p]).min())


def test_one_by_one_is_as_all_at_once(index):
    rng = seeds.generator(2, "asks")
    categories, sizes, latents = ["cabinet", "dining_chair"] * 5, rng.uniform(0.3, 2.2, (10, 3)), rng.normal(0, 1, (10, 32))
    whole = matches(index, categories, sizes, latents)
    for p in range(10):
        single = matches(index, categories[p : p + 1], sizes[p : p + 1], latents[p : p + 1])[0]
        assert (single.asset_id, single.distance) == (whole[p].asset_id, pytest.approx(whole[p].distance))


def test_what_the_library_lacks_is_none(index):
    assert matches(index, ["sauna"], np.ones((1, 3)), np.zeros((1, 32))) == [None]


def test_the_order_of_the_tables_does_not_matter(index):
    assets, latents, joints = tables()
    again = AssetIndex.from_tables(assets[::-1], latents[::-1], joints)
    rng = seeds.generator(3, "asks")
    sizes, latent = rng.uniform(0.3, 2.2, (20, 3)), rng.normal(0, 1, (20, 32))
    ids = [[m.asset_id for m in matches(i, ["cabinet"] * 20, sizes, latent)] for i in (index, again)]
    assert ids[0] == ids[1]


def test_ties_go_to_the_smaller_id():
    size = [1.0, 1.0, 1.0]
    assets = [{"asset_id": a, "category": "c", "split": "train", "size": size, "articulated": False, "openable": False} for a in "zyx"]
    latents = [{"asset_id": a, "latent": [0.0] * 32} for a in "xyz"]
    twins = AssetIndex.from_tables(assets, latents)
    assert matches(twins, ["c"], np.array([size]), np.zeros((1, 32)))[0].asset_id == "x"


def test_articulated_assets_are_never_scaled_and_static_ones_little(index):
    rng = seeds.generator(4, "asks")
    for match in matches(index, ["cabinet"] * 60 + ["bathtub"] * 5, rng.uniform(0.3, 3.0, (65, 3)), rng.normal(0, 1, (65, 32))):
        row = index.row(match.asset_id)
        np.testing.assert_allclose(match.size, index.sizes[row] * match.scale)
        if index.articulated[row]:
            assert (match.scale == 1).all()
        assert (np.abs(match.scale - 1) <= 0.15 + 1e-9).all()


def test_what_opens_is_preferred():
    rng = seeds.generator(5, "asks")
    sizes, latents = rng.uniform(0.4, 2.0, (200, 3)), rng.normal(0, 1, (200, 32))
    share = []
    for factor, offset in ((1.0, 0.0), (1.5, 0.15), (10.0, 1.0)):
        built = AssetIndex.from_tables(*tables(), RetrievalSettings(prefer_openable=factor, prefer_offset=offset))
        share.append(np.mean([m.openable for m in matches(built, ["cabinet"] * 200, sizes, latents)]))
    assert share[0] < share[1] <= share[2]


def test_smaller_is_smaller_of_the_same_category_and_still_opens(index):
    for name in index.asset_ids:
        row = index.row(name)
        area = float(np.prod(index.sizes[row][:2]))
        match = index.smaller(Taste(), name, area)
        smaller = [r for r in index.shelves[index.categories[row]] if np.prod(index.sizes[r][:2]) < area - 1e-9]
        assert (match is None) == (not smaller)
        if match:
            assert match.asset_id != name
            assert np.prod(match.size[:2]) < area
            if index.openable[row] and index.openable[smaller].any():
                assert match.openable


def test_smaller_until_nothing_is_left_ends(index):
    name, seen = "cabinet_00", []
    while (match := index.smaller(Taste(), name, float(np.prod(index.sizes[index.row(name)][:2])))) is not None:
        seen.append(match.asset_id)
        name = match.asset_id
    assert len(seen) == len(set(seen)) < 30


def test_lookup_tells_sizes_and_sweeps_of_what_match_finds(index):
    rng = seeds.generator(6, "asks")
    categories = [["cabinet", None, "dining_chair"], ["bathtub", "cabinet", None]]
    sizes, latents = rng.uniform(0.4, 2.0, (2, 3, 3)), rng.normal(0, 1, (2, 3, 32)).astype(np.float32)
    placed, sweeps = index.lookup([Taste(), None], categories, np.zeros((2, 3, 3)), sizes, latents)
    assert sweeps.shape == (2, 3, 4, 2, 3)
    for b, n in ((0, 0), (0, 2), (1, 0), (1, 1)):
        match = matches(index, [categories[b][n]], sizes[b, n][None], latents[b, n][None])[0]
        np.testing.assert_allclose(placed[b, n], match.size)
        assert np.isfinite(sweeps[b, n]).any() == match.openable
    np.testing.assert_allclose(placed[0, 1], sizes[0, 1])
    assert np.isnan(sweeps[0, 1]).all()


def test_a_library_without_latents_is_named():
    assets, latents, joints = tables()
    with pytest.raises(ContentError, match="cabinet_00"):
        AssetIndex.from_tables(assets, latents[1:], joints)
    with pytest.raises(ContentError, match="'sauna'"):
        AssetIndex.from_tables(assets, latents, joints).row("sauna")


def test_a_library_without_furniture_is_named():
    with pytest.raises(ContentError, match="no furniture"):
        AssetIndex.from_tables([], [], [])

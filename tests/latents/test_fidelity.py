import numpy as np

from pipeline.latents.training import self_ranking

STORED = np.array([[0, 0], [1, 0], [1.02, 0], [9, 9]], np.float32)
CATEGORIES = ["chair", "chair", "chair", "bed"]


def rank(queries, between=0.5, itself=0.1, asked=(0, 1, 2, 3)):
    return self_ranking(STORED, np.array(queries, np.float32), CATEGORIES, asked, lambda i, j: between, lambda i: itself)


def test_all_find_themselves():
    found = rank(STORED)
    assert (found.asked, found.first, found.excused, found.rate) == (4, 4, 0, 1.0)


def test_another_category_is_no_rival():
    assert rank([[9, 9], [1, 0], [1.02, 0], [0, 0]], asked=(3,)).rate == 1.0


def test_a_shape_that_is_nearer_to_another_fails():
    found = rank([[0, 0], [1.02, 0], [1.02, 0], [9, 9]])
    assert (found.first, found.rate) == (3, 0.75)


def test_a_twin_does_not_count_against_it_but_is_counted():
    found = rank([[0, 0], [1.02, 0], [1.02, 0], [9, 9]], between=0.05)
    assert (found.first, found.excused) == (4, 1)


def test_a_tie_in_latents_is_a_failure():
    same = np.zeros_like(STORED)
    found = self_ranking(same, same, CATEGORIES, [0, 1, 2], lambda i, j: 1.0, lambda i: 0.1)
    assert found.first == 0

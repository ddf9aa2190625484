"""What each home of a dataset is asked to be."""

from collections import Counter

import pytest

from pipeline.errors import ContentError, UsageError
from pipeline.shards import Mix, read_mix, require_prompt


def test_lines_are_taken_in_turn(tmp_path):
    path = tmp_path / "prompts.txt"
    path.write_text("# mine\n a studio \n\ntwo bedrooms\n", encoding="utf-8")
    mix = read_mix(path)
    assert [mix.prompt(3, i) for i in range(5)] == ["a studio", "two bedrooms", "a studio", "two bedrooms", "a studio"]


def test_a_mix_is_drawn_by_weight_and_by_index_alone(tmp_path):
    path = tmp_path / "mix.yaml"
    path.write_text("- {prompt: a studio, weight: 3}\n- {prompt: two bedrooms}\n- a loft\n", encoding="utf-8")
    mix = read_mix(path)
    assert mix.weights == (3.0, 1.0, 1.0)
    drawn = Counter(mix.prompt(3, i) for i in range(2000))
    assert abs(drawn["a studio"] / 2000 - 0.6) < 0.05
    assert drawn["a loft"] > 300
    assert [mix.prompt(3, i) for i in range(20)] == [mix.prompt(3, i) for i in range(20)]
    assert [mix.prompt(3, i) for i in range(20)] != [mix.prompt(4, i) for i in range(20)]


def test_no_mix_asks_for_nothing():
    assert Mix().prompt(0, 5) == ""


def test_digest_tells_mixes_apart():
    mixes = [Mix(), Mix(("a",)), Mix(("a", "b")), Mix(("b", "a")), Mix(("a",), (1.0,)), Mix(("a",), (2.0,))]
    assert len({m.digest() for m in mixes}) == len(mixes)


@pytest.mark.parametrize("text", ["", "  \n\t", "x" * 20_001, "x" * 1_000_000, "a\0b", "a\x1b[2Jb"])
def test_prompts_that_are_none_are_the_users_error(text):
    with pytest.raises(UsageError) as caught:
        require_prompt(text)
    assert len(str(caught.value)) < 200


def test_a_prompt_may_have_lines_and_letters_of_all_kinds():
    assert require_prompt(" une cuisine à l'américaine\nund ein Bad, 日本 ") == "une cuisine à l'américaine\nund ein Bad, 日本"


@pytest.mark.parametrize(
    ("name", "data", "error", "word"),
    [
        ("p.txt", b"", UsageError, "holds no prompt"),
        ("p.txt", b"# only\n", UsageError, "holds no prompt"),
        ("p.txt", b"ok\n" + b"x" * 1_000_000, UsageError, "line 2"),
        ("p.txt", b"\xff\xfe\x00", ContentError, "UTF-8"),
        ("p.yaml", b"- {prompt: a, weight: 0}", ContentError, "weight 0"),
        ("p.yaml", b"- {prompt: a, weight: .inf}", ContentError, "weight inf"),
        ("p.yaml", b"- {prompt: a, weight: true}", ContentError, "weight True"),
        ("p.yaml", b"- {prompt: a, wieght: 2}", ContentError, "entry 1"),
        ("p.yaml", b"- {prompt: ''}", UsageError, "entry 1"),
        ("p.yaml", b"a: b", ContentError, "not a list"),
        ("p.yaml", b"[", ContentError, "not YAML"),
        ("p.yaml", b"[]", UsageError, "holds no prompt"),
    ],
)
def test_bad_files_are_named(tmp_path, name, data, error, word):
    (tmp_path / name).write_bytes(data)
    with pytest.raises(error, match=word) as caught:
        read_mix(tmp_path / name)
    assert name in str(caught.value)


def test_paths_of_the_wrong_kind_are_the_users_error(tmp_path):
    with pytest.raises(UsageError, match="missing"):
        read_mix(tmp_path / "none.txt")
    with pytest.raises(UsageError, match="not a file"):
        read_mix(tmp_path)

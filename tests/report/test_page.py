import base64
import re

import pytest

from pipeline.errors import ContentError
from pipeline.report import viewer
from pipeline.report.page import Picture, Section, TableView, render
from pipeline.report.plots import Curve, bars, lines
from pipeline.report.viewer import viewer_page

PNG = b"\x89PNG\r\n"


def test_page_shows_everything_and_escapes_it():
    section = Section("Homes <1>", ["a & b"], [TableView("t", ("x", "y"), [["1", "<2>"]])], [Picture("views/a.png", 'a "view"')])
    page = render("Title", "lead", [section])
    assert "Homes &lt;1&gt;" in page
    assert "a &amp; b" in page
    assert "<td>&lt;2&gt;</td>" in page
    assert 'src="views/a.png"' in page
    assert "http" not in page


def test_a_picture_opens_a_page():
    page = render("Title", "lead", [Section("Homes", pictures=[Picture("a.png", "a", "a.html")])])
    assert '<a href="a.html"><img src="a.png"' in page


def test_the_viewer_holds_the_file_and_fetches_nothing():
    glb = bytes(range(256))
    page = viewer_page("s0_00000003", glb)
    assert base64.b64decode(re.search('base64_data="([^"]*)"', page)[1]) == glb
    assert "<title>s0_00000003</title>" in page
    assert not re.search(r"""(src|href)=["']?(https?:)?//""", page)


def test_another_viewer_is_named(monkeypatch):
    monkeypatch.setitem(viewer.REPLACED, "what no viewer has", "")
    with pytest.raises(ContentError, match=r"trimesh .* has another text than 'what no viewer has'; pip install"):
        viewer_page("s0_00000003", b"")


def test_plots_are_pictures_and_repeat_byte_for_byte():
    curves = [Curve("ours", [1, 2, 3], [0.1, 0.5, 0.9], [0.0, 0.4, 0.8], [0.2, 0.6, 1.0])]
    first, again = (lines(curves, title="t", x="x", y="y", y_range=(0, 1)) for _ in range(2))
    assert first.startswith(PNG)
    assert first == again
    assert lines([Curve("ours", [1, 2, 3], [0.9, 0.5, 0.1])], title="t", x="x", y="y") != first
    assert bars({"a": [1.0, 2.0]}, ["p", "q"], title="t", y="y").startswith(PNG)

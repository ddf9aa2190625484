from pipeline.report.page import Picture, Section, TableView, render
from pipeline.report.plots import Curve, bars, lines

PNG = b"\x89PNG\r\n"


def test_page_shows_everything_and_escapes_it():
    section = Section("Homes <1>", ["a & b"], [TableView("t", ("x", "y"), [["1", "<2>"]])], [Picture("views/a.png", 'a "view"')])
    page = render("Title", "lead", [section])
    assert "Homes &lt;1&gt;" in page
    assert "a &amp; b" in page
    assert "<td>&lt;2&gt;</td>" in page
    assert 'src="views/a.png"' in page
    assert "http" not in page


def test_plots_are_pictures_and_repeat_byte_for_byte():
    curves = [Curve("ours", [1, 2, 3], [0.1, 0.5, 0.9], [0.0, 0.4, 0.8], [0.2, 0.6, 1.0])]
    first, again = (lines(curves, title="t", x="x", y="y", y_range=(0, 1)) for _ in range(2))
    assert first.startswith(PNG)
    assert first == again
    assert lines([Curve("ours", [1, 2, 3], [0.9, 0.5, 0.1])], title="t", x="x", y="y") != first
    assert bars({"a": [1.0, 2.0]}, ["p", "q"], title="t", y="y").startswith(PNG)

"""Writes what a command has measured between its lines `<!-- measure: NAME -->` and `<!-- end -->` of a page of docs/.

    scripts/write_figures.py PAGE NAME < TEXT
"""
import pathlib
import re
import sys

DOCS = pathlib.Path(__file__).resolve().parent.parent / "docs"


def place_of(page, name):
    """Where a page has the text between its two lines."""
    pattern = r"<!-- measure: %s -->\n((?:(?!<!-- ).)*)<!-- end -->" % re.escape(name)
    places = list(re.finditer(pattern, (DOCS / page).read_text(), re.DOTALL))
    if len(places) != 1:
        sys.exit("write_figures: %s has %d places for %s" % (page, len(places), name))
    return places[0].span(1)


def figures(page, name):
    """The text between the two lines of a page."""
    begin, end = place_of(page, name)
    return (DOCS / page).read_text()[begin:end]


def write_figures(page, name, text):
    begin, end = place_of(page, name)
    page_text = (DOCS / page).read_text()
    (DOCS / page).write_text(page_text[:begin] + text.strip() + "\n" + page_text[end:])


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    write_figures(sys.argv[1], sys.argv[2], sys.stdin.read())

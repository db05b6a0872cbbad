"""Writes what a command has measured between its lines `<!-- measure: NAME -->` and `<!-- end -->` of a page of docs/.

    scripts/write_figures.py PAGE NAME < TEXT
"""
import pathlib
import re
import sys

DOCS = pathlib.Path(__file__).resolve().parent.parent / "docs"


def write_figures(page, name, text):
    path = DOCS / page
    pattern = re.compile(r"(<!-- measure: %s -->\n)(?:(?!<!-- ).)*(<!-- end -->)" % re.escape(name), re.DOTALL)
    new, count = pattern.subn(lambda m: m.group(1) + text.strip() + "\n" + m.group(2), path.read_text())
    if count != 1:
        sys.exit("write_figures: %s has %d places for %s" % (page, count, name))
    path.write_text(new)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    write_figures(sys.argv[1], sys.argv[2], sys.stdin.read())

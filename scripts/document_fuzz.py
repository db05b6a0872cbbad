#!/usr/bin/python3
"""Writes what a coverage-guided target has come to into the table of docs/reliability.md.

    document_fuzz.py SECONDS TARGET LOG

The rows of other targets stay, as long as sources and seconds are the same.
"""
import pathlib
import re
import sys

from document_campaign import sources
from write_figures import figures, write_figures

COLUMNS = ["target", "runs", "edges of the control flow", "findings"]


def last(pattern, text):
    """What a pattern has found last, or 0."""
    return (re.findall(pattern, text, re.MULTILINE) or ["0"])[-1]


def main():
    seconds, target, log = int(sys.argv[1]), sys.argv[2], pathlib.Path(sys.argv[3])
    text = log.read_text(errors="replace")
    head = ["`scripts/fuzz --document %d` of the sources `%s`:" % (seconds, sources("fuzz")), "",
            "| " + " | ".join(COLUMNS) + " |", "| " + " | ".join("---" for _ in COLUMNS) + " |"]
    written = figures("reliability.md", "fuzz").splitlines()
    rows = {row.split("`")[1]: row for row in written[len(head):]} if written[:len(head)] == head else {}
    cells = [f"`{target}`", last(r"^stat::number_of_executed_units: *(\d+)", text), last(r" cov: (\d+)", text),
             str(text.count("Test unit written"))]
    rows[target] = "| " + " | ".join(cells) + " |"
    write_figures("reliability.md", "fuzz", "\n".join([*head, *rows.values()]))


if __name__ == "__main__":
    main()

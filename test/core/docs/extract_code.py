#!/usr/bin/python3
"""Writes the code of a page of docs/ to files: the fences with one file name, in their order, make one file.

    extract_code.py PAGE.md OUT_DIR

A fence says its language and its file: ```cpp sledge.cpp. What a program prints is in a fence ```text PROGRAM and goes to
PROGRAM.expected.txt. Fails at a fence without a file name, so that no code escapes the tests.
"""
import os
import re
import sys


def fences(page):
    """(language, file, text) of each fence."""
    found = []
    fence = None
    for number, line in enumerate(page.splitlines(keepends=True), 1):
        opening = re.fullmatch(r"```(\w+) ?(\S*)\s*", line)
        if fence is not None and line.rstrip() == "```":
            found.append(fence)
            fence = None
        elif fence is not None:
            fence = (fence[0], fence[1], fence[2] + line)
        elif opening and opening.group(2):
            fence = (opening.group(1), opening.group(2), "")
        elif line.startswith("```"):
            sys.exit("line %d: a fence needs a language and the name of its file" % number)
    if fence is not None:
        sys.exit("the fence of %s has no end" % fence[1])
    return found


def main(page, directory):
    files = {}
    with open(page, encoding="utf-8") as file:
        for language, name, text in fences(file.read()):
            name += ".expected.txt" if language == "text" else ""
            files[name] = files.get(name, "") + text
    for name, text in files.items():
        path = os.path.join(directory, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])

#!/usr/bin/python3
"""Makes a source file of each installed header: the header alone, then the example of its comments as a function.

    extract_examples.py INCLUDE_DIR OUT_DIR

Fails where a header has no example (@code ... @endcode), but for those in WITHOUT.
"""
import pathlib
import re
import sys

WITHOUT = {"export.hpp", "mechanics/automatic.hpp"}  # macros; two headers in one
FILE = """#include "hybrid_sphere/%s"

namespace hybrid_sphere {
void example_of_%s();
void example_of_%s() {
%s}
}  // namespace hybrid_sphere
"""


def main(include, out):
    root = pathlib.Path(include) / "hybrid_sphere"
    for header in sorted(root.rglob("*.hpp")):
        name = header.relative_to(root).as_posix()
        code = "".join(re.findall(r"/// @code\n(.*?)/// @endcode", header.read_text(), re.S))
        code = re.sub(r"^/// ?", "  ", code, flags=re.M)
        if not code and name not in WITHOUT:
            sys.exit("%s has no example" % name)
        function = re.sub(r"\W", "_", name[: -len(".hpp")])
        file = pathlib.Path(out) / (function + ".cpp")
        text = FILE % (name, function, function, code)
        if not file.exists() or file.read_text() != text:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])

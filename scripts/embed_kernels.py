#!/usr/bin/env python3
"""Writes a C++ file that holds the given kernel sources, named as in the folder: embed_kernels.py OUT.cpp FOLDER FILE.cl..."""
import os
import sys


def literal(text):
    """C++ raw string literals of at most 8 kB each, adjacent ones being joined by the compiler."""
    pieces = [text[i : i + 8000] for i in range(0, len(text), 8000)] or [""]
    return "\n".join('R"kernel(%s)kernel"' % piece for piece in pieces)


def main():
    out, folder, files = sys.argv[1], sys.argv[2], sorted(sys.argv[3:])
    lines = [
        '#include "wavetank/sph/kernel_sources.h"',
        "",
        "namespace wavetank {",
        "",
        "const compute::SourceFiles& embedded_kernel_sources() {",
        "  static const compute::SourceFiles files = {",
    ]
    for path in files:
        with open(path, encoding="utf-8") as source:
            lines.append('    {"%s", %s},' % (os.path.relpath(path, folder), literal(source.read())))
    lines += ["  };", "  return files;", "}", "", "}  // namespace wavetank", ""]
    with open(out, "w", encoding="utf-8") as target:
        target.write("\n".join(lines))


if __name__ == "__main__":
    main()

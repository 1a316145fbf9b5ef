#!/usr/bin/env python3
"""Writes a C++ file that holds the given kernel sources: embed_kernels.py OUT.cpp FILE.cl..."""
import os
import sys


def literal(text):
    """C++ raw string literals of at most 8 kB each, adjacent ones being joined by the compiler."""
    pieces = [text[i:i + 8000] for i in range(0, len(text), 8000)] or [""]
    return "\n".join('R"kernel(%s)kernel"' % piece for piece in pieces)


def main():
    out, files = sys.argv[1], sorted(sys.argv[2:])
    lines = ['#include "wavetank/sph/kernel_sources.h"', "", "namespace wavetank {", "",
             "const compute::SourceFiles& embedded_kernel_sources() {", "  static const compute::SourceFiles files = {"]
    for path in files:
        with open(path, encoding="utf-8") as source:
            lines.append('    {"%s", %s},' % (os.path.basename(path), literal(source.read())))
    lines += ["  };", "  return files;", "}", "", "}  // namespace wavetank", ""]
    with open(out, "w", encoding="utf-8") as target:
        target.write("\n".join(lines))


if __name__ == "__main__":
    main()

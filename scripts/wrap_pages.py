#!/usr/bin/env python3
"""Breaks the lines of Markdown and of the changelog that are longer than 160 characters: scripts/wrap_pages.py [--check] FILE...

A line is broken at the last blank before its end, and what is left over goes in front of the line after it, so that as few lines as may be change. Rows of
tables, code and headings cannot be broken; code and links within a line are kept whole. --check changes nothing, names the lines, and exits with 1.
"""

import re
import sys

COLUMNS = 160
ITEM = re.compile(r"(?:[-*+]|\d+[.)]) +")
# What would mean something else at the beginning of a line.
MARKS = re.compile(r"[-*+#>|=~]|\d+[.)]|`{3}")


def blanks(line):
    """Places of the blanks at which a line may be broken."""
    kept = [match.span() for match in re.finditer(r"``.*?``|`[^`]*`|!?\[[^]]*\]\([^)]*\)|<[^>]*>", line)]
    for match in re.finditer(" ", line):
        place = match.start()
        if not any(begin < place < end for begin, end in kept) and not MARKS.match(line[place + 1 :]):
            yield place


def indentation(line):
    """Of the lines that continue this one."""
    lead = line[: len(line) - len(line.lstrip())]
    item = ITEM.match(line.lstrip())
    return lead + " " * item.end() if item else lead


def parts(line):
    """The line in two, or None if it cannot be broken."""
    first = len(indentation(line))
    places = [place for place in blanks(line) if first < place <= COLUMNS]
    return (line[: places[-1]], line[places[-1] + 1 :]) if places else None


def continues(line, following):
    text = following.strip()
    same = len(following) - len(following.lstrip()) == len(indentation(line))
    return bool(text) and same and not ITEM.match(text) and not MARKS.match(text) and not text.startswith("!") and not line.endswith("  ")


def wrapped(lines):
    lines, result, code = list(lines), [], False
    while lines:
        line = lines.pop(0)
        if line.lstrip().startswith("```"):
            code = not code
        pieces = None
        if len(line) > COLUMNS and not code and not line.lstrip().startswith(("|", "#")):
            pieces = parts(line)
        if pieces:
            line, rest = pieces
            if lines and continues(line, lines[0]):
                lines[0] = indentation(line) + rest + " " + lines[0].lstrip()
            else:
                lines.insert(0, indentation(line) + rest)
        result.append(line)
    return result


def too_long(lines):
    """Numbers of the lines that are longer than they may be, but for rows of tables."""
    return [number for number, line in enumerate(lines, 1) if len(line) > COLUMNS and not line.lstrip().startswith("|")]


def main(arguments):
    check = arguments[:1] == ["--check"]
    status = 0
    for path in arguments[1:] if check else arguments:
        with open(path, encoding="utf-8") as file:
            lines = file.read().split("\n")
        if not check:
            lines = wrapped(lines)
            with open(path, "w", encoding="utf-8") as file:
                file.write("\n".join(lines))
        for number in too_long(lines):
            print("%s:%d: longer than %d characters" % (path, number, COLUMNS))
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

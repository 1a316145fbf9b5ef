#!/usr/bin/env python3
"""compare_fields.py ONE OTHER: what digests has written of two versions; exit code 1 if they differ by more than rounding."""
import sys

import numpy

MOST = 1e-6  # of the greatest value of a field: some last digits of single precision


def cases_of(path):
    cases, name = {}, None
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("#"):
                name = line[2:].strip()
                cases[name] = []
            else:
                cases[name].append([float(word) for word in line.split()])
    return {name: numpy.array(rows) for name, rows in cases.items()}


def main():
    one, other = cases_of(sys.argv[1]), cases_of(sys.argv[2])
    if not one or one.keys() != other.keys() or any(one[name].shape != other[name].shape for name in one):
        sys.exit("compare_fields: they are not the same cases, or not of as many particles")
    worst = 0
    for name in one:
        found = []
        for columns in (slice(0, 3), slice(3, 6), slice(6, 7)):
            difference = numpy.abs(one[name][:, columns] - other[name][:, columns]).max() / numpy.abs(one[name][:, columns]).max()
            found.append(difference)
        print("%-46s places %.1e, velocities %.1e, pressures %.1e" % (name, *found))
        worst = numpy.max([worst, *found])  # not a number if one is
    print("they differ by rounding alone" if worst <= MOST else "they differ by more than rounding")
    return 0 if worst <= MOST else 1


sys.exit(main())

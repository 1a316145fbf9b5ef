"""Runs of a case over some of its keys' values, and one table of their key figures."""

import argparse
import csv
import itertools
import os
import re

import numpy

from wavetank import Failure
from wavetank.recording import Recording
from wavetank.runs import Run, Runner, numbers_of, read_case

TABLE = "table.csv"


def split_values(text):
    """At the commas that are in no bracket."""
    values, depth, begin = [], 0, 0
    for place, letter in enumerate(text):
        depth += (letter in "[{") - (letter in "]}")
        if letter == "," and depth == 0:
            values.append(text[begin:place])
            begin = place + 1
    return [value.strip() for value in values + [text[begin:]]]


def read_vary(text):
    """(key, values as text) of KEY=VALUE,VALUE,... or KEY=FIRST:LAST:COUNT. Raises Failure."""
    key, equals, values = text.partition("=")
    if not (key and equals and values):
        raise Failure("--vary '%s' is not KEY=VALUE,VALUE,..., as in --vary fluid/spacing=0.02,0.01" % text)
    if re.fullmatch(r"[^\[{,]*:[^,]*:\d+", values):
        return key, ["%.10g" % number for number in numbers_of(values, "the values of --vary " + key)]
    result = split_values(values)
    if "" in result:
        raise Failure("--vary '%s' has an empty value" % text)
    if len(set(result)) < len(result):
        raise Failure("--vary '%s' has a value twice" % text)
    return key, result


def read_setting(text):
    key, equals, value = text.partition("=")
    if not (key and equals):
        raise Failure("--set '%s' is not KEY=VALUE, as in --set fluid/spacing=0.02" % text)
    return key, value


def short_names(keys):
    """The last word of each key or, where two have the same, the whole key with dots."""
    last = [key.split("/")[-1] for key in keys]
    return [word if last.count(word) == 1 else key.replace("/", ".") for key, word in zip(keys, last)]


def name_of(names, values):
    return "+".join("%s=%s" % (name, re.sub(r"[^A-Za-z0-9.+-]+", "_", value)) for name, value in zip(names, values))


def combinations(case, varied, settings, options):
    """Runs of all combinations, the last key's values changing first, each with its values."""
    keys = [key for key, _ in varied]
    for key in keys:
        if keys.count(key) > 1:
            raise Failure("--vary %s is given twice" % key)
        if key in [other for other, _ in settings]:
            raise Failure("'%s' is both varied and set" % key)
    names = short_names(keys)
    runs = []
    for values in itertools.product(*(values for _, values in varied)):
        runs.append(Run(name_of(names, values), case, list(settings) + list(zip(keys, values)), options))
    found = [run.name for run in runs]
    for number, run in enumerate(runs):  # values that differ only by what a folder's name cannot have
        if found.count(run.name) > 1:
            run.name += "+%d" % found[: number + 1].count(run.name)
    return runs


def figures_of(path, begin):
    """Key figures of a bag by name, unit in brackets: peaks, levels, mean forces from `begin` (s) on, energies at the end, and the time of a step."""
    recording = Recording(path)
    figures = {}
    table = recording.table("status") if "status" in recording.names else ()
    if len(table):  # a run that failed at once may have announced it alone
        status = table.columns
        figures["simulated (s)"] = status["simulated_time"][-1]
        figures["steps"] = int(status["step"][-1])
        rates = status["steps_per_second"][status["steps_per_second"] > 0]
        if len(rates):
            figures["time a step (ms)"] = 1000.0 / rates[-1]
        for energy in ("kinetic", "potential", "compression"):
            figures["%s energy at the end (J)" % energy] = status[energy + "_energy"][-1]
    for name in recording.names:
        if name not in ("probes", "gauges") and not name.endswith("/wrench"):
            continue
        table = recording.table(name)
        for column, values in table.columns.items():
            if name == "probes":
                figures["%s peak (Pa)" % column] = values.max()
            elif name == "gauges":
                figures["%s least (m)" % column] = values.min()
                figures["%s greatest (m)" % column] = values.max()
            elif (table.times >= begin).any():
                figures["%s mean %s (%s)" % (name.split("/")[-2], column, table.units[column])] = values[table.times >= begin].mean()
    return figures


def rows_of(results, varied, begin):
    """One a run: its values, exit code, sentence and figures, by the columns' names."""
    rows = []
    for result in results:
        row = {"run": result.run.name}
        row.update((key, value) for key, value in result.run.settings if key in [each for each, _ in varied])
        row["exit code"] = result.exit_code
        if result.bag:
            try:
                row.update(figures_of(result.bag, begin))
            except Failure as failure:
                result.sentence = result.sentence or str(failure)
        row["failure"] = result.sentence
        rows.append(row)
    return rows


def text_of(value):
    if isinstance(value, (float, numpy.floating)):
        return repr(float(value))
    return str(value)


def columns_of(rows):
    """In the rows' order, the sentence last."""
    columns = list(dict.fromkeys(column for row in rows for column in row if column != "failure"))
    return columns + ["failure"]


def write_table(rows, path):
    columns = columns_of(rows)
    temporary = path + ".part"
    with open(temporary, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows([text_of(row.get(column, "")) for column in columns] for row in rows)
    os.replace(temporary, path)


def print_table(rows, across=5):
    """Figures down, runs across, a few at a time."""

    def cell(value):
        return "%.5g" % value if isinstance(value, (float, numpy.floating)) else str(value)

    for begin in range(0, len(rows), across):
        part = rows[begin : begin + across]
        columns = [column for column in columns_of(part) if column not in ("run", "failure")]
        width = max(len(column) for column in columns)
        cells = [[cell(row.get(column, "-")) for column in ["run"] + columns] for row in part]
        widths = [max(len(text) for text in texts) for texts in cells]
        for n, column in enumerate(["run"] + columns):
            print("  ".join(["%-*s" % (width, column)] + ["%*s" % (w, texts[n]) for w, texts in zip(widths, cells)]))
        print()
    for row in rows:
        if row["failure"]:
            print("%s failed: %s" % (row["run"], row["failure"]))


def read_arguments(arguments):
    parser = argparse.ArgumentParser(
        prog="sweep",
        description="Runs a case for every combination of some of its keys' values, and puts the key figures of all runs into one table, DIR/%s." % TABLE,
        epilog="Runs that are in DIR already are not repeated. Exit code: 0 all done, 1 a run failed, 2 an error, 130 interrupted: the same command goes on.",
    )
    parser.add_argument("case", help="the case, a YAML file")
    parser.add_argument(
        "-v", "--vary", metavar="KEY=VALUES", action="append", required=True,
        help="values of a key, as fluid/spacing=0.02,0.01 or fluid/spacing=FIRST:LAST:COUNT; may be repeated",
    )  # fmt: skip
    parser.add_argument("-o", "--out", metavar="DIR", required=True, help="folder for the runs and the table")
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="a key of all runs; may be repeated")
    parser.add_argument("--duration", metavar="S", help="simulated time instead of the case's, s")
    parser.add_argument("--device", help="OpenCL device, as wavetank_run takes it")
    parser.add_argument("--clouds", action="store_true", help="with the free surface's particles in the bags")
    parser.add_argument("--from", dest="begin", type=float, default=0.0, metavar="T", help="of the mean forces, s of simulated time; default 0")
    parser.add_argument("--again", action="store_true", help="run anew what was run before with another case")
    return parser.parse_args(arguments)


def main(arguments):
    options = read_arguments(arguments)
    read_case(options.case)
    varied = [read_vary(text) for text in options.vary]
    passed_on = [word for flag in ("duration", "device") if getattr(options, flag) for word in ("--" + flag, getattr(options, flag))]
    passed_on += ["--clouds"] if options.clouds else []
    runs = combinations(options.case, varied, [read_setting(text) for text in options.set], passed_on)
    results = Runner(options.out, options.again).do(runs)
    rows = rows_of(results, varied, options.begin)
    path = os.path.join(options.out, TABLE)
    write_table(rows, path)
    print_table(rows)
    print("table  %s" % path)
    return 1 if any(row["failure"] for row in rows) else 0

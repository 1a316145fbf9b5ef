"""Writes what a bag holds as files that others read."""

import argparse
import os

from wavetank import Failure
from wavetank.recording import Recording
from wavetank.vtk_files import write_vtk

ROWS_AT_ONCE = 5000


def time_texts(stamps):
    """Seconds to the nanosecond, without rounding: 1.25 for 1250000000."""
    for stamp in stamps.tolist():
        whole, rest = divmod(stamp, 1000000000)
        yield ("%d.%09d" % (whole, rest)).rstrip("0").rstrip(".")


def head_of(column, unit):
    return "%s (%s)" % (column, unit) if unit else column


def quoted(text):
    return '"%s"' % text.replace('"', '""') if any(letter in text for letter in ',"\n') else text


def file_name(name):
    return name.replace("/", ".") + ".csv"


def write_csv(table, path):
    """One line of columns' names with their units, then one a sample. Numbers are the shortest that are read back as the same bits; points, whatever the
    locale."""
    columns = list(table.columns.values())
    heads = ["time (s)"] + [head_of(name, table.units[name]) for name in table.columns]
    with open(path + ".part", "w", encoding="utf-8", newline="\n") as file:
        file.write(",".join(quoted(head) for head in heads) + "\n")
        for begin in range(0, len(table), ROWS_AT_ONCE):
            part = slice(begin, begin + ROWS_AT_ONCE)
            # as objects of Python, whose repr is the shortest text of the same bits
            cells = [time_texts(table.stamps[part])] + [map(repr, column[part].tolist()) for column in columns]
            file.writelines(",".join(row) + "\n" for row in zip(*cells))
    os.replace(path + ".part", path)


def csv_files(tables, folder):
    os.makedirs(folder, exist_ok=True)
    for table in tables:
        path = os.path.join(folder, file_name(table.name))
        write_csv(table, path)
        yield path


def write_hdf5(tables, recording, path):
    """A group for each instrument with a data set for each column, _time (s) and _stamp (ns); no instrument's name begins so. Attributes have units, positions
    and frames; _case is the case's text."""
    try:
        import h5py
    except ImportError:
        raise Failure("--hdf5 needs h5py: install python3-h5py, or write CSV by --csv DIR")
    with h5py.File(path + ".part", "w") as file:
        file.attrs["source"] = os.path.basename(recording.path)
        case = recording.text("case")
        if case:
            file.create_dataset("_case", data=case)
        for table in tables:
            group = file.create_group(table.name)
            group.attrs["frame"] = table.frame
            group.create_dataset("_time", data=table.times).attrs["unit"] = "s"
            group.create_dataset("_stamp", data=table.stamps).attrs["unit"] = "ns"
            for name, values in table.columns.items():
                data = group.create_dataset(name, data=values)
                data.attrs["unit"] = table.units[name]
                if name in table.positions:
                    data.attrs["position"] = table.positions[name]
    os.replace(path + ".part", path)


def read_arguments(arguments):
    parser = argparse.ArgumentParser(
        prog="export",
        description="Writes what a bag holds as files that others read: CSV, HDF5, or VTK for ParaView.",
        epilog="pandas.read_csv(FILE, float_precision='round_trip') reads the bag's very bits; without it, it rounds the last of them.",
    )
    parser.add_argument("bag", help="written by wavetank_run or rosbag record")
    form = parser.add_mutually_exclusive_group(required=True)
    form.add_argument("--csv", metavar="DIR", help="a file for each instrument, or for those that are sampled together, into this folder")
    form.add_argument("--vtk", metavar="DIR", help="point clouds, tank and bodies for ParaView, into this folder: open DIR/case.pvd")
    form.add_argument("--hdf5", metavar="FILE", help="all into one file of HDF5, which needs h5py")
    parser.add_argument("-i", "--instrument", metavar="NAME", action="append", help="only this, as probes or bodies/hull/wrench; may be repeated")
    parser.add_argument("-n", "--namespace", help="of the tank, if the bag holds several (/wavetank)")
    return parser.parse_args(arguments)


def main(arguments):
    options = read_arguments(arguments)
    recording = Recording(options.bag, options.namespace)
    try:
        if options.vtk:
            print("wrote '%s'" % write_vtk(recording, options.vtk))
            return
        tables = [recording.table(name) for name in options.instrument or recording.names]
        tables = [table for table in tables if table.columns]
        if options.csv:
            for path in csv_files(tables, options.csv):
                print("wrote '%s'" % path)
        else:
            write_hdf5(tables, recording, options.hdf5)
            print("wrote '%s'" % options.hdf5)
    except OSError as error:
        raise Failure("cannot write '%s': %s" % (options.csv or options.hdf5 or options.vtk, error.strerror or error))

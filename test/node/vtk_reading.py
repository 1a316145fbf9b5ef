"""Reads files for ParaView by the format's own description."""

import os
import re
import struct
import xml.etree.ElementTree
import zlib

import numpy

TYPES = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "UInt32": "<u4", "UInt8": "u1"}


def block(raw, offset):
    (count,) = struct.unpack_from("<Q", raw, offset)
    if count == 0:
        return b""
    length, rest = struct.unpack_from("<QQ", raw, offset + 8)
    assert (count, rest) == (1, 0), "one block was to be written"
    (packed,) = struct.unpack_from("<Q", raw, offset + 24)
    data = zlib.decompress(raw[offset + 32 : offset + 32 + packed])
    assert len(data) == length
    return data


def read_vtp(path):
    """Arrays of a file of polygons by name, and how many cells there are of each kind."""
    with open(path, "rb") as file:
        head, _, raw = file.read().partition(b'<AppendedData encoding="raw">\n_')
    assert b'compressor="vtkZLibDataCompressor"' in head and b'header_type="UInt64"' in head
    arrays = {}
    for kind, name, width, offset in re.findall(rb'<DataArray type="(\w+)" Name="(\w+)" NumberOfComponents="(\d)" format="appended" offset="(\d+)"', head):
        data = block(raw, int(offset))
        if kind == b"String":
            arrays[name.decode()] = [text.decode() for text in data.split(b"\0")[:-1]]
        else:
            values = numpy.frombuffer(data, TYPES[kind.decode()])
            arrays[name.decode()] = values.reshape(-1, int(width)) if width != b"1" else values
    return arrays, {kind.decode(): int(count) for kind, count in re.findall(rb'NumberOf(\w+)="(\d+)" ?', head.split(b"<Piece ")[1].split(b">")[0])}


def read_collection(path):
    """[(time, name, file)], the files as paths."""
    folder = os.path.dirname(path)
    entries = xml.etree.ElementTree.parse(path).getroot().iter("DataSet")
    return [(float(entry.get("timestep")), entry.get("name"), os.path.join(folder, entry.get("file"))) for entry in entries]

"""Turns serialised messages of any type into arrays, many at a time: by the definition that the bag brings along, so that bags of other versions
can be read too."""

import struct

import numpy

NUMBERS = {
    "bool": "u1", "byte": "i1", "char": "u1", "int8": "i1", "uint8": "u1", "int16": "<i2", "uint16": "<u2", "int32": "<i4", "uint32": "<u4",
    "int64": "<i8", "uint64": "<u8", "float32": "<f4", "float64": "<f8",
}  # fmt: skip
PAIRS = {"time": ("uint32", "uint32"), "duration": ("int32", "int32")}


def read_definition(kind, text):
    """Members of the type and of all that it uses: lists of (name, type, length) by type, the length None of what is no list and -1 where it varies."""
    types, current = {kind: []}, kind
    for line in text.splitlines():
        line = line.split("#")[0].strip()
        if line.startswith("MSG:"):
            current = line[4:].strip()
            types[current] = []
        elif line and "=" not in line:  # not a constant, nor a line between types
            member, name = line.split()[:2]
            member, bracket, length = member.partition("[")
            count = None if not bracket else int(length[:-1]) if length != "]" else -1
            types[current].append((name, member, count))
    return {each: [(name, full_name(member, each, types), count) for name, member, count in members] for each, members in types.items()}


def full_name(member, owner, types):
    if member in NUMBERS or member in PAIRS or member == "string" or member in types:
        return member
    if member == "Header":
        return "std_msgs/Header"
    return owner.split("/")[0] + "/" + member


class Layout:
    """Where the numbers and texts of messages lie that are laid out as a given one is."""

    def __init__(self, types, kind, sample):
        self._types, self._sample, self._place = types, sample, 0
        self.numbers, self.texts, self.lengths = {}, {}, []  # by path: [(place, type, count)], [(place, length)]; places of the lengths
        self._add(kind, "")

    def _add(self, kind, path):
        for name, member, count in self._types[kind]:
            self._add_member(member, count, path + name)

    def _length(self):
        (length,) = struct.unpack_from("<I", self._sample, self._place)
        self.lengths.extend(range(self._place, self._place + 4))
        self._place += 4
        return length

    def _add_member(self, member, count, path):
        if count == -1:
            count = self._length()
        if member in NUMBERS:
            self._add_numbers(member, 1 if count is None else count, path)
            return
        for _ in range(1 if count is None else count):
            if member == "string":
                length = self._length()
                self.texts.setdefault(path, []).append((self._place, length))
                self._place += length
            elif member in PAIRS:
                for part, number in zip(("secs", "nsecs"), PAIRS[member]):
                    self._add_numbers(number, 1, path + "." + part)
            else:
                self._add(member, path + ".")

    def _add_numbers(self, member, count, path):
        kind = numpy.dtype(NUMBERS[member])
        self.numbers.setdefault(path, []).append((self._place, kind, count))
        self._place += kind.itemsize * count


def decode(types, kind, rows):
    """Parts (numbers, texts, which) of messages that are the rows of an array: of each path an array of a row a message, or the messages' texts, the
    same for all of a part; `which` tells the rows of the part. Messages of different lists or texts are in different parts."""
    parts, left = [], numpy.arange(len(rows))
    while len(left):
        layout = Layout(types, kind, rows[left[0]].tobytes())
        same = layout.lengths + [place + n for texts in layout.texts.values() for place, length in texts for n in range(length)]
        alike = (rows[left][:, same] == rows[left[0], same]).all(axis=1)
        which, left = left[alike], left[~alike]
        numbers = {path: numpy.concatenate([columns(rows[which], *place) for place in places], axis=1) for path, places in layout.numbers.items()}
        texts = {
            path: [rows[which[0], place : place + length].tobytes().decode("utf-8", "replace") for place, length in places]
            for path, places in layout.texts.items()
        }
        parts.append((numbers, texts, which))
    return parts


def columns(rows, place, kind, count):
    width = kind.itemsize * count
    return numpy.ascontiguousarray(rows[:, place : place + width]).view(kind).reshape(len(rows), count)


def read_tree(types, kind, data):
    """One message as nested dictionaries and lists; lists of numbers, or of types of nothing but numbers such as points, as arrays."""
    return Tree(types, data).read(kind)


class Tree:
    """A place in the bytes of a message, from which its parts are read one after the other."""

    def __init__(self, types, data):
        self._types, self._data, self._place = types, data, 0

    def read(self, kind):
        return {name: self._member(member, count) for name, member, count in self._types[kind]}

    def _take(self, kind, count=1):
        kind = numpy.dtype(kind)
        values = numpy.frombuffer(self._data, kind, count, self._place)
        self._place += kind.itemsize * count
        return values

    def _member(self, member, count):
        if count is None:
            return self._one(member)
        if count == -1:
            count = int(self._take("<u4")[0])
        plain = self._plain(member)
        if plain is not None:
            return self._take(plain, count)
        return [self._one(member) for _ in range(count)]

    def _plain(self, member):
        """The type as numpy has it, where it is of nothing but numbers, one after the other."""
        if member in NUMBERS:
            return numpy.dtype(NUMBERS[member])
        parts = [(name, self._plain(each) if count is None else None) for name, each, count in self._types.get(member, [])]
        return numpy.dtype(parts) if parts and all(part is not None for _, part in parts) else None

    def _one(self, member):
        if member in NUMBERS:
            return self._take(NUMBERS[member])[0]
        if member == "string":
            return self._take("u1", int(self._take("<u4")[0])).tobytes().decode("utf-8", "replace")
        if member in PAIRS:
            return tuple(int(self._take(NUMBERS[part])[0]) for part in PAIRS[member])
        return self.read(member)

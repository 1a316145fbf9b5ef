"""Reads bag files of format 2.0 by their index, all messages of a connection at once: rosbag's own reader takes them one by one, some ten
thousand a second, and a bag with samples at 1 kHz has hundreds of thousands."""

import bz2
import contextlib
import os
import struct

import numpy

from wavetank import Failure

MAGIC = b"#ROSBAG V2.0\n"
MESSAGE, BAG_HEADER, INDEX, CHUNK, CONNECTION = 2, 3, 4, 5, 7


class Connection:
    """One publisher of a topic: the topic, the type of its messages and their definition."""

    def __init__(self, topic, kind, definition):
        self.topic, self.kind, self.definition = topic, kind, definition


def fields_of(header):
    fields, place = {}, 0
    while place < len(header):
        (length,) = struct.unpack_from("<I", header, place)
        name, _, value = bytes(header[place + 4 : place + 4 + length]).partition(b"=")
        fields[name.decode("ascii")] = value
        place += 4 + length
    return fields


def words_at(data, places):
    """The 32-bit words that begin at these places of an array of bytes."""
    return data[places[:, None] + numpy.arange(4)].view("<u4").ravel().astype(numpy.int64)


class BagFile:
    """connections: by id. Raises Failure if the file cannot be read."""

    def __init__(self, path):
        self.path = path
        self._check_there()
        try:
            self._data = numpy.asarray(numpy.memmap(path, dtype=numpy.uint8, mode="r")) if os.path.getsize(path) else numpy.empty(0, numpy.uint8)
        except OSError as error:
            raise Failure("'%s' cannot be read as a bag: %s" % (path, error.strerror or error))
        if bytes(self._data[: len(MAGIC)]) != MAGIC:
            raise Failure("'%s' is no bag: it does not begin with '#ROSBAG V2.0'" % path)
        self.connections = {}
        self._chunks = None
        self._last_chunk = (None, None)
        try:
            self._read_index()
        except (IndexError, KeyError, ValueError, struct.error):
            raise self._unreadable()

    def _check_there(self):
        path = self.path
        if os.path.isdir(path):
            raise Failure("'%s' is a folder, not a bag" % path)
        if os.path.isfile(path):
            return
        if os.path.isfile(path + ".active"):
            raise Failure(
                "there is no bag '%s' but '%s.active': it is being written, or the run that wrote it died; then rosbag reindex '%s.active' makes it readable"
                % (path, path, path)
            )
        raise Failure("there is no bag '%s'" % path)

    def _unreadable(self):
        if self.path.endswith(".active"):
            return Failure("'%s' is not whole: it is being written, or the run that wrote it died; then rosbag reindex makes it readable" % self.path)
        return Failure("'%s' is not whole and has no index: rosbag reindex makes it readable" % self.path)

    @contextlib.contextmanager
    def reading(self, kind):
        """Raises Failure where messages of that type are not as their definition has them."""
        try:
            yield
        except (IndexError, KeyError, TypeError, ValueError, struct.error):
            raise Failure("'%s' holds a %s that cannot be read" % (self.path, kind))

    def _record(self, place):
        """Fields of the header, and begin and end of the data, of the record at a place."""
        (length,) = struct.unpack_from("<I", self._data, place)
        begin = place + 4 + length
        (data_length,) = struct.unpack_from("<I", self._data, begin)
        if begin + 4 + data_length > len(self._data):
            raise IndexError
        return fields_of(self._data[place + 4 : begin]), begin + 4, begin + 4 + data_length

    def _read_index(self):
        header, _, place = self._record(len(MAGIC))
        (self._index_place,) = struct.unpack("<Q", header["index_pos"])
        self._records_place = place
        if not self._records_place <= self._index_place <= len(self._data):
            raise IndexError
        place = self._index_place
        while place < len(self._data):
            header, begin, place = self._record(place)
            if header["op"][0] == CONNECTION:
                self._add_connection(header, self._data[begin:place])

    def _add_connection(self, header, data):
        fields = fields_of(data)
        (number,) = struct.unpack("<I", header["conn"])
        self.connections[number] = Connection(
            header["topic"].decode("utf-8"), fields["type"].decode("ascii"), fields["message_definition"].decode("utf-8", "replace")
        )

    def messages(self, wanted):
        """Of each connection in `wanted` (a set of ids) its messages as a list of arrays of bytes, a row a message: those of one chunk and length."""
        found = {number: [] for number in wanted}
        try:
            for header, begin, end, indices in self._all_chunks():
                if not found.keys() & indices.keys():
                    continue
                chunk = self._chunk(header, begin, end)
                for number in found.keys() & indices.keys():
                    for entries in self._entries(indices[number]):
                        found[number].extend(cut(chunk, entries["offset"].astype(numpy.int64)))
        except (IndexError, KeyError, ValueError, struct.error):
            raise self._unreadable()
        return found

    def places(self, number):
        """Where the messages of a connection are, for message(), each with the time (ns) that it was recorded: those that are large are read one at a time."""
        try:
            return [
                ((n, int(offset)), int(time))
                for n, (_, _, _, indices) in enumerate(self._all_chunks())
                for entries in self._entries(indices.get(number, []))
                for offset, time in zip(entries["offset"], entries["secs"].astype(numpy.int64) * 1000000000 + entries["nsecs"])
            ]
        except (IndexError, KeyError, ValueError, struct.error):
            raise self._unreadable()

    def message(self, place, length=None):
        """The bytes of the message at a place, or the first of them."""
        number, offset = place
        try:
            if self._last_chunk[0] != number:
                self._last_chunk = (number, self._chunk(*self._all_chunks()[number][:3]))
            chunk = self._last_chunk[1]
            (header,) = struct.unpack_from("<I", chunk, offset)
            (whole,) = struct.unpack_from("<I", chunk, offset + 4 + header)
            begin = offset + 8 + header
            if begin + whole > len(chunk):
                raise IndexError
            return chunk[begin : begin + (whole if length is None else min(whole, length))].tobytes()
        except (IndexError, KeyError, ValueError, struct.error):
            raise self._unreadable()

    def _all_chunks(self):
        if self._chunks is None:
            self._chunks = list(self._scan())
        return self._chunks

    def _entries(self, places):
        for first, last in places:
            yield numpy.frombuffer(self._data[first:last].tobytes(), dtype=[("secs", "<u4"), ("nsecs", "<u4"), ("offset", "<u4")])

    def _scan(self):
        """Of each chunk its header, where its data begin and end, and by connection where the records of its index do."""
        place, chunk = self._records_place, None
        while place < self._index_place:
            fields, begin, end = self._record(place)
            if fields["op"][0] == CHUNK:
                if chunk:
                    yield chunk
                chunk = (fields, begin, end, {})
            elif fields["op"][0] == INDEX:
                (number,) = struct.unpack("<I", fields["conn"])
                chunk[3].setdefault(number, []).append((begin, end))
            place = end
        if chunk:
            yield chunk

    def _chunk(self, header, begin, end):
        data = self._data[begin:end]
        compression = header["compression"]
        if compression == b"none":
            return data
        try:
            whole = self._decompressor(compression)(data.tobytes())
        except (OSError, ValueError):
            raise self._unreadable()
        if len(whole) != struct.unpack("<I", header["size"])[0]:  # roslz4 takes what is cut short
            raise self._unreadable()
        return numpy.frombuffer(whole, dtype=numpy.uint8)

    def _decompressor(self, compression):
        if compression == b"bz2":
            return bz2.decompress
        try:
            import roslz4
        except ImportError:
            raise Failure("'%s' is compressed by %s: rosbag decompress makes it readable" % (self.path, compression.decode("ascii", "replace")))
        return roslz4.decompress


def cut(chunk, offsets):
    """The messages whose records begin at these offsets of a chunk: arrays of rows of one length each."""
    begins = offsets + 4 + words_at(chunk, offsets)
    lengths = words_at(chunk, begins)
    for length in numpy.unique(lengths):
        yield chunk[(begins[lengths == length] + 4)[:, None] + numpy.arange(length)]

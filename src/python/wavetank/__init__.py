"""What wavetank's bags hold, for Python: tables of numpy arrays, or data frames of pandas.

    import wavetank
    frames = wavetank.read_bag("out.bag")        # by name: "probes", "gauges", "bodies/hull/odom", "status", ...
    frames["probes"]["P1"].max()                 # Pa; the index is simulated time, s
    frames["probes"].attrs["units"]["P1"]        # "Pa"

Nothing heavy is imported before it is asked for: this package also holds the messages, which every node imports.
"""


class Failure(Exception):
    """Something the user can put right; its text is one sentence."""


def read_tables(path, namespace=None, wanted=None):
    """The bag's instruments as tables of numpy arrays by name (see wavetank.recording.Table), without pandas.

    namespace: of the tank, where the bag holds several. wanted: a function of a name that tells which to read; None: all.
    Raises Failure."""
    from wavetank.recording import Recording

    recording = Recording(path, namespace)
    tables = (recording.table(name) for name in recording.names if wanted is None or wanted(name))
    return {table.name: table for table in tables if table.columns}


def read_bag(path, namespace=None, wanted=None):
    """The same as data frames of pandas, whose index is the simulated time in s; attrs has "units" by column, "frame" and, of probes and gauges,
    "positions" by column (m). Every value has the bits that the bag has. Raises Failure."""
    return {name: table.data_frame() for name, table in read_tables(path, namespace, wanted).items()}

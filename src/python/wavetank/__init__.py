"""wavetank for Python: tanks that are simulated here, and what bags hold, as tables of numpy arrays or data frames of pandas.

    import wavetank
    frames = wavetank.read_bag("out.bag")        # by name: "probes", "gauges", "bodies/hull/odom", "status", ...
    frames["probes"]["P1"].max()                 # Pa; the index is simulated time, s
    frames["probes"].attrs["units"]["P1"]        # "Pa"

    with wavetank.Tank("case.yaml", {"fluid/spacing": 0.02}) as tank:    # needs no ROS: docs/python.md
        tank.advance(0.02)
        tank.gauges["middle"]                    # m

Nothing heavy is imported before it is asked for: this package also holds the messages, which every node imports.
"""


class Failure(Exception):
    """Something the user can put right; its text is one sentence."""


class Error(Failure):
    """What wavetank.Tank refuses, or what the simulation cannot do."""


class Stopped(Error):
    """The watchdog stopped the simulation: its text says which particle, where and when."""


def __getattr__(name):
    # Tank is looked for when it is asked for, since its extension may not have been built.
    if name == "Tank":
        from wavetank.tank import Tank

        return Tank
    raise AttributeError("module 'wavetank' has no attribute '%s'" % name)


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

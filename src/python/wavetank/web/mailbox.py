"""What waits for one client."""

from collections import deque

from wavetank.web.packets import series_packet
from wavetank.web.series import Series


class Mailbox:
    """Between the server and a client: of each kind of picture the newest alone, of samples all (thinned beyond a bound), answers one by one. So a client that
    does not read costs bounded memory, and it loses pictures and nothing else."""

    def __init__(self):
        self._newest, self._series, self._answers = {}, {}, deque()

    def put(self, kind, packet):
        """In the place of one of that kind that still waits."""
        self._newest[kind] = packet

    def drop(self, kind):
        self._newest.pop(kind, None)

    def drop_samples(self):
        self._series.clear()

    def answer(self, text):
        self._answers.append(text)

    def answers(self):
        """How many wait. A client's requests are looked at only while there are few, so there are never many."""
        return len(self._answers)

    def add(self, table, times, values, clear=False):
        """Samples. table: a dictionary with name, columns and units. clear: those before are of another run."""
        name = table["name"]
        if clear or name not in self._series or self._series[name][0] != table:
            clear = clear or (name in self._series and self._series[name][2])
            self._series[name] = (table, Series(len(table["columns"])), clear)
        self._series[name][1].add(times, values)

    def take(self, pictures=True):
        """The next that is to be sent: an answer, samples, a picture if those are wanted, or None; and whether it is a picture."""
        if self._answers:
            return self._answers.popleft(), False
        if self._series:
            table, series, clear = self._series.pop(next(iter(self._series)))
            return series_packet(table, series.times, series.values, clear), False
        if self._newest and pictures:
            return self._newest.pop(next(iter(self._newest))), True
        return None, False

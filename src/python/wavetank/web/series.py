"""Samples of an instrument in bounded memory."""

import numpy


def thinned(times, values):
    """Half as many samples: of every four the least and the greatest of each column, in the order in which the column goes. So peaks stay; what is over four is
    kept as it is."""
    groups = len(times) // 4
    whole = 4 * groups
    four = values[:whole].reshape(groups, 4, values.shape[1])
    low, high = numpy.fmin.reduce(four, axis=1), numpy.fmax.reduce(four, axis=1)
    falls = four[:, 0] > four[:, 3]
    two = numpy.stack([numpy.where(falls, high, low), numpy.where(falls, low, high)], axis=1).reshape(2 * groups, values.shape[1])
    at = numpy.stack([times[0:whole:4], times[3:whole:4]], axis=1).ravel()
    return numpy.concatenate([at, times[whole:]]), numpy.concatenate([two, values[whole:]])


class Series:
    """At most `limit` samples. Where there are more, all but the newest quarter are thinned, the oldest again and again."""

    def __init__(self, columns, limit=4096):
        self._limit = limit
        self.times, self.values = numpy.empty(0), numpy.empty((0, columns))

    def __len__(self):
        return len(self.times)

    def add(self, times, values):
        self.times, self.values = numpy.concatenate([self.times, times]), numpy.concatenate([self.values, values])
        while len(self.times) > self._limit:
            old = max(len(self.times) - self._limit // 4, 4)
            times, values = thinned(self.times[:old], self.values[:old])
            self.times, self.values = numpy.concatenate([times, self.times[old:]]), numpy.concatenate([values, self.values[old:]])

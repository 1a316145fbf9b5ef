"""Small heave of a rectangular box in the middle of a rectangular tank, in two dimensions, by linear potential theory: no viscosity, no compression, waves and
their reflections from the tank's ends included. What a simulated decay is held against."""

import math

import numpy


class LinearHeave:
    """The box's breadth and draught, the tank's length and the depth of the water at rest, m. `cell`: of a grid that divides all of them and half the first
    and third, m. Per metre of width."""

    def __init__(self, breadth, draught, length, depth, cell, density=1000.0, gravity=9.81):
        self.breadth, self.draught, self.length, self.depth, self.cell = breadth, draught, length, depth, cell
        self.density, self.gravity = density, gravity
        self.half_box, self.below, self.rows = self._cells(0.5 * breadth), self._cells(depth - draught), self._cells(depth)
        self.columns = self._cells(0.5 * length)
        self.surface = self.columns - self.half_box
        self.mass = density * breadth * draught
        self.stiffness = density * gravity * breadth
        self._solve()

    def _cells(self, length):
        count = round(length / self.cell)
        if abs(count * self.cell - length) > 1e-6 * length:
            raise ValueError("%g m is not a multiple of the cell of %g m" % (length, self.cell))
        return count

    def _open(self, column):
        """Rows of a column that hold water, from the floor up."""
        return self.below if column < self.half_box else self.rows

    def _shared(self, column):
        """Rows through which a column is open to the next one; 0 at the tank's end."""
        return self._open(column) if column + 1 < self.columns else 0

    def _balance(self, column):
        """Of what flows out of each cell of a column: the matrix of its own potentials, and what the causes let in. Rows in the box stay zero."""
        height = self._open(column)
        matrix, known = numpy.eye(self.rows), numpy.zeros((self.rows, 1 + self.surface))
        matrix[:height, :height] = closed_column(height)
        for shared in (self._shared(column), self._shared(column - 1) if column else 0):
            matrix[range(shared), range(shared)] -= 1.0
        if column < self.half_box:
            known[height - 1, 0] = -self.cell  # the box's bottom, which rises, lets water out
        else:
            matrix[height - 1, height - 1] -= 2.0  # half a cell to the surface
            known[height - 1, 1 + column - self.half_box] = -2.0
        return matrix, known

    def _solve(self):
        """Laplace's equation in the half right of the middle, for all causes at once: a unit velocity of the box, a unit potential on each surface cell.

        Column by column: potentials = right - link · (potentials of the next column).
        """
        links, rights = [], []
        for column in range(self.columns):
            matrix, known = self._balance(column)
            if column:
                before = self._shared(column - 1)
                matrix[:before] -= links[-1][:before]
                known[:before] -= rights[-1][:before]
            onward = numpy.diag((numpy.arange(self.rows) < self._shared(column)).astype(float))
            links.append(numpy.linalg.solve(matrix, onward))
            rights.append(numpy.linalg.solve(matrix, known))
        potentials = [rights[-1]]
        for link, right in zip(links[-2::-1], rights[-2::-1]):
            potentials.insert(0, right - link.dot(potentials[0]))
        self._collect(potentials)

    def _collect(self, potentials):
        bottom = sum(potentials[column][self.below - 1] for column in range(self.half_box))
        bottom[0] += self.half_box * 0.5 * self.cell  # from the cells' middles up to the box
        bottom = 2.0 * self.cell * bottom  # both halves: the integral over the bottom
        self.added_mass = self.density * bottom[0]  # kg/m, below a surface free of pressure: of motions too fast for waves
        self.pull = bottom[1:]  # of the surface's potentials on that integral, m
        top = numpy.array([potentials[column][-1] for column in range(self.half_box, self.columns)])
        self.rise = -top * 2.0 / self.cell  # the surface's velocity by cause
        self.rise[:, 1:] += numpy.eye(self.surface) * 2.0 / self.cell

    def period_without_waves(self):
        """2π √((m + a)/(ρ g b)), s: what it would be without waves, which carry energy off and slow it down."""
        return 2 * math.pi * math.sqrt((self.mass + self.added_mass) / self.stiffness)

    def decay(self, displacement, duration, rate=200.0):
        """Times and heights over rest (m), let go at `displacement` with the water at rest, whose level is as much lower as the box is out of it."""
        states = 2 + 2 * self.surface  # height, velocity, the surface's heights and potentials
        heights, potentials = slice(2, 2 + self.surface), slice(2 + self.surface, states)
        matrix = numpy.zeros((states, states))
        matrix[0, 1] = 1.0
        inertia = self.mass + self.added_mass
        matrix[1, 0] = -self.stiffness / inertia
        matrix[1, heights] = self.density * self.gravity * self.pull / inertia
        matrix[heights, 1] = self.rise[:, 0]
        matrix[heights, potentials] = self.rise[:, 1:]
        matrix[potentials, heights] = -self.gravity * numpy.eye(self.surface)
        state = numpy.zeros(states)
        state[0] = displacement
        state[heights] = -displacement * self.breadth / (self.length - self.breadth)
        count = int(round(duration * rate)) + 1
        values, vectors = numpy.linalg.eig(matrix)
        parts = numpy.linalg.solve(vectors, state.astype(complex)) * vectors[0]
        times = numpy.arange(count) / rate
        return times, numpy.real(numpy.exp(numpy.outer(times, values)).dot(parts))


def closed_column(height):
    """Each cell's differences to those above and below it."""
    matrix = numpy.zeros((height, height))
    for row in range(height - 1):
        matrix[row, row] -= 1.0
        matrix[row + 1, row + 1] -= 1.0
        matrix[row, row + 1] = matrix[row + 1, row] = 1.0
    return matrix

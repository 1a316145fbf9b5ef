"""Turns in space: angles of poses, and matrices of angles (roll, pitch and yaw about fixed axes, REP 103)."""

import numpy


def angles_of(quaternions):
    """Roll, pitch and yaw (rad) of rows x y z w; yaw and roll, and in the plane pitch, without jumps."""
    x, y, z, w = quaternions.T
    flat = (x == 0) & (z == 0)
    if len(quaternions) and numpy.all(flat):
        pitch = numpy.unwrap(2.0 * numpy.arctan2(y, w))
        return numpy.column_stack([numpy.zeros_like(pitch), pitch, numpy.zeros_like(pitch)])
    roll = numpy.arctan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    pitch = numpy.arcsin(numpy.clip(2.0 * (w * y - z * x), -1.0, 1.0))
    yaw = numpy.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    return numpy.column_stack([numpy.unwrap(roll), pitch, numpy.unwrap(yaw)])


def turn_about(axis, angle):
    """The matrix of a turn by an angle (rad) about x, y or z (0, 1, 2)."""
    result = numpy.eye(3)
    first, second = (axis + 1) % 3, (axis + 2) % 3
    result[first, first] = result[second, second] = numpy.cos(angle)
    result[second, first] = numpy.sin(angle)
    result[first, second] = -result[second, first]
    return result


def matrix_of(angles):
    """Of roll, pitch and yaw in rad."""
    return turn_about(2, angles[2]) @ turn_about(1, angles[1]) @ turn_about(0, angles[0])


def angles_of_matrix(matrix):
    """Roll, pitch and yaw in rad; where pitch is a right angle, without yaw."""
    pitch = numpy.arcsin(numpy.clip(-matrix[2, 0], -1.0, 1.0))
    if abs(matrix[2, 0]) > 1 - 1e-12:
        return numpy.array([numpy.arctan2(-matrix[1, 2], matrix[1, 1]), pitch, 0.0])
    return numpy.array([numpy.arctan2(matrix[2, 1], matrix[2, 2]), pitch, numpy.arctan2(matrix[1, 0], matrix[0, 0])])

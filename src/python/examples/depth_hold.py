#!/usr/bin/env python3
"""Takes a box that would rise to a depth and holds it there: a PID controller drives a thruster fifty times a second of simulated time.

Needs no ROS: source devel/setup.bash; src/python/examples/depth_hold.py
"""

import os

import wavetank

CASE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "diving_box.yaml")
SURFACE = 0.4  # m, of the water at rest
GOAL = 0.25  # m under it; the box begins 0.15 m under it
PERIOD = 0.02  # s, between two looks at the depth
STRONGEST = 20.0  # N per metre of width, that the thruster can do either way

# The box weighs 9 kg to a metre of width, and about as much water moves with it.
PROPORTIONAL = 500.0  # N/m
INTEGRAL = 600.0  # N/(m s): finds the 7.5 N by which the box is too light
NEAR = 0.02  # m from the goal, where the integral begins to count; on the way there it would only overshoot
DERIVATIVE = 150.0  # N s/m


def hold(tank, seconds):
    """Depths at the ends of the periods, m."""
    box = tank.bodies["box"]
    depths, sum_of_errors = [], 0.0
    for _ in range(round(seconds / PERIOD)):
        depth = SURFACE - box.position[2]
        error = GOAL - depth
        if abs(error) < NEAR:
            sum_of_errors += error * PERIOD
        down = PROPORTIONAL * error + INTEGRAL * sum_of_errors + DERIVATIVE * box.velocity[2]
        down = max(-STRONGEST, min(STRONGEST, down))
        box.push(force=[0, 0, -down])  # held until the next one
        tank.advance(PERIOD)
        depths.append(SURFACE - box.position[2])
    return depths


def main(seconds=4.0):
    with wavetank.Tank(CASE) as tank:
        depths = hold(tank, seconds)
    for n in range(0, len(depths), 10):
        print("%4.2f s   %.3f m deep" % ((n + 1) * PERIOD, depths[n]))
    return depths


if __name__ == "__main__":
    main()

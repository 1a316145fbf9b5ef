#!/usr/bin/env python3
"""The tank as an environment with reset() and step(action), as reinforcement learning wants it; their meaning is that of gymnasium, which is not needed.

Needs no ROS: source devel/setup.bash; src/python/examples/gym_loop.py
"""

import os

import numpy

import wavetank

CASE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "diving_box.yaml")


class DivingBox:
    """A box under water that is to come to a height and stay there. An action is the thruster's push upwards, -1 to 1; an observation is height over the goal (m)
    and velocity upwards (m/s); the reward is the less the farther it is from the goal. An episode is over when the box shows at the surface or
    the simulation is stopped, and cut off after a while."""

    GOAL = 0.15  # m over the floor
    HIGHEST = 0.33  # m
    STRONGEST = 20.0  # N per metre of width
    PERIOD = 0.05  # s, that an action lasts
    LONGEST = 40  # periods

    def __init__(self):
        self.tank = wavetank.Tank(CASE)
        self.box = self.tank.bodies["box"]
        self.periods = 0

    def reset(self):
        self.tank.reset()  # the same start to the last bit, in milliseconds: nothing is laid out or compiled again
        self.periods = 0
        return self.observation(), {}

    def step(self, action):
        push = self.STRONGEST * float(numpy.clip(action, -1.0, 1.0))
        self.box.push(force=[0, 0, push])
        self.periods += 1
        try:
            self.tank.advance(self.PERIOD)
        except wavetank.Stopped as stopped:
            return self.observation(), -1.0, True, False, {"stopped": str(stopped)}
        observation = self.observation()
        reward = -abs(float(observation[0]))
        at_surface = bool(self.box.position[2] > self.HIGHEST)
        return observation, reward, at_surface, self.periods >= self.LONGEST, {"time": self.tank.time}

    def close(self):
        self.tank.close()

    def observation(self):
        return numpy.array([self.box.position[2] - self.GOAL, self.box.velocity[2]])


def episode(environment, policy):
    """The observations, and the sum of the rewards."""
    observation, _ = environment.reset()
    observations, total, is_over = [observation], 0.0, False
    while not is_over:
        observation, reward, terminated, truncated, _ = environment.step(policy(observation))
        observations.append(observation)
        total += reward
        is_over = terminated or truncated
    return numpy.array(observations), total


def by_hand(observation):
    return -0.4 - 12.0 * observation[0] - 5.0 * observation[1]


def main():
    environment = DivingBox()
    for name, policy in (("nothing", lambda observation: 0.0), ("by hand", by_hand)):
        observations, total = episode(environment, policy)
        print("%-8s %2d periods, return %.2f, at last %+.3f m from the goal" % (name, len(observations) - 1, total, observations[-1][0]))
    environment.close()


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Whether still water has stayed so: still_water.py BAG NAME

Prints one line: the floor's pressure over the hydrostatic one, how far it swings, kinetic over potential energy. Fails if the pressure's swing in any of
the last eleven twelfths of the run is above 1 % of the hydrostatic one, or the kinetic energy grows."""

import sys

import rosbag


def main():
    bag, name = sys.argv[1:]
    pressures, kinetic, potential = [], [], []
    with rosbag.Bag(bag) as messages:
        for topic, message, _ in messages.read_messages():
            if topic.endswith("/probes/floor"):
                pressures.append(message.fluid_pressure)
            elif topic.endswith("/status"):
                kinetic.append(message.kinetic_energy)
                potential.append(message.potential_energy)
    expected = 1000 * 9.81 * 0.3
    length = len(pressures) // 12
    parts = [pressures[k * length : (k + 1) * length] for k in range(1, 12)]
    swing = max(max(part) - min(part) for part in parts) / expected
    third = len(kinetic) // 3
    before, after = max(kinetic[len(kinetic) // 12 : third]), max(kinetic[-third:])
    still = swing < 0.01 and (after < 2 * before or after < 1e-6 * potential[0])
    print(
        "%-60s mean %.4f to %.4f, swing %.4f of rho g H; kinetic over potential energy %.1e, then %.1e%s"
        % (
            name,
            min(sum(part) / len(part) for part in parts) / expected,
            max(sum(part) / len(part) for part in parts) / expected,
            swing,
            before / potential[0],
            after / potential[0],
            "" if still else "  NOT STILL",
        )
    )
    sys.exit(0 if still else 1)


if __name__ == "__main__":
    main()

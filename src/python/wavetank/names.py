"""Names of the case as ROS has them."""

import re


def level_of(name):
    """A name of the case as one level of a topic: what ROS does not allow there becomes an underscore."""
    return re.sub(rb"[^A-Za-z0-9_]", b"_", name.encode()).decode()

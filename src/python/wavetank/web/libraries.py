"""What the page has of others, as Debian installs it."""

import os

JAVASCRIPT = "/usr/share/javascript"
LIBRARIES = {  # by the name that the page has for them: the file, and the Debian package
    "three.js": ("three/three.min.js", "libjs-three"),
    "orbit.js": ("three/examples/js/controls/OrbitControls.js", "libjs-three"),
    "dygraph.js": ("dygraphs/dygraph.min.js", "libjs-dygraphs"),
    "dygraph.css": ("dygraphs/dygraph.min.css", "libjs-dygraphs"),
}


def library_path(name):
    return os.path.join(JAVASCRIPT, LIBRARIES[name][0])


def missing_packages():
    return sorted({package for name, (_, package) in LIBRARIES.items() if not os.path.isfile(library_path(name))})

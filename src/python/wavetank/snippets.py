"""A body's coefficients as text for other simulators. In all of them x is ahead, y to port and z up, as here.

uuv_simulator (fossen): the added mass is a matrix of 36 positive numbers, dampings are six negative ones. gz (Hydrodynamics): SNAME's derivatives, all negative.
Stonefish computes added mass and damping from the geometry by itself; a scenario can replace drag coefficients, of forces over ½ ρ U² and the area."""

from wavetank.body_cases import DIRECTIONS

GZ = {  # added mass, linear and quadratic damping
    "surge": ("xDotU", "xU", "xUabsU"),
    "sway": ("yDotV", "yV", "yVabsV"),
    "heave": ("zDotW", "zW", "zWabsW"),
    "roll": ("kDotP", "kP", "kPabsP"),
    "pitch": ("mDotQ", "mQ", "mQabsQ"),
    "yaw": ("nDotR", "nR", "nRabsR"),
}


def listed(values):
    return " ".join("%.6g" % (value or 0.0) for value in values)  # no -0


def head(body, coefficients, dimensions):
    missing = [direction for direction in DIRECTIONS if direction not in coefficients]
    lines = ["<!-- %s, by wavetank hydrodynamics. %s" % (body, "; ".join(coefficients[each]["from"] for each in DIRECTIONS if each in coefficients))]
    if missing:
        lines.append("     Not measured, and therefore 0: %s." % ", ".join(missing))
    if dimensions == 2:
        lines.append("     Of a tank in two dimensions: a metre of width; multiply by the body's width.")
    return "\n".join(lines) + " -->\n"


def column(coefficients, name):
    return [coefficients.get(direction, {}).get(name, 0.0) for direction in DIRECTIONS]


def uuv_simulator(body, coefficients, density, dimensions):
    added = column(coefficients, "added_mass")
    rows = [listed(added[i] if i == k else 0.0 for k in range(6)) for i in range(6)]
    return head(body, coefficients, dimensions) + (
        "<hydrodynamic_model>\n  <type>fossen</type>\n  <added_mass>\n    %s\n  </added_mass>\n"
        "  <linear_damping>%s</linear_damping>\n  <quadratic_damping>%s</quadratic_damping>\n</hydrodynamic_model>\n"
    ) % ("\n    ".join(rows), listed(-value for value in column(coefficients, "linear")), listed(-value for value in column(coefficients, "quadratic")))


def gz(body, coefficients, density, dimensions):
    lines = ['<plugin filename="gz-sim-hydrodynamics-system" name="gz::sim::systems::Hydrodynamics">', "  <link_name>%s</link_name>" % body]
    lines.append("  <water_density>%.6g</water_density>" % density)
    for direction in DIRECTIONS:
        for tag, name in zip(GZ[direction], ("added_mass", "linear", "quadratic")):
            lines.append("  <%s>%.6g</%s>" % (tag, -coefficients.get(direction, {}).get(name, 0.0) or 0.0, tag))
    return head(body, coefficients, dimensions) + "\n".join(lines + ["</plugin>"]) + "\n"


def stonefish(body, coefficients, density, dimensions):
    drag = [coefficients.get(direction, {}).get("drag_coefficient") for direction in DIRECTIONS[:3]]
    text = head(body, coefficients, dimensions)
    if not any(value is not None for value in drag):
        return text + "<!-- Stonefish takes drag coefficients alone, which a tow finds; it computes added mass from the geometry. -->\n"
    # where one was not measured, a bluff body's
    return text + '<!-- 1 stands for a direction that was not towed. -->\n<hydrodynamics quadratic_drag="%s"/>\n' % listed(
        1.0 if value is None else value for value in drag
    )


WRITERS = {"uuv_simulator.xml": uuv_simulator, "gz.sdf": gz, "stonefish.xml": stonefish}

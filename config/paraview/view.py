"""Shows a run of wavetank in ParaView: paraview --script=view.py, or with pvpython a picture: pvpython view.py --png FILE [--at S] [--size 1280x720].

The water's surface where there is one, or else its particles coloured by their speed; the tank as glass, bodies, probes (red) and gauges (green)."""

import argparse
import os
import sys
import xml.etree.ElementTree

from paraview.simple import (
    ColorBy,
    GetActiveViewOrCreate,
    GetAnimationScene,
    GetColorTransferFunction,
    Hide,
    PVDReader,
    RenameSource,
    Render,
    ResetCamera,
    SaveScreenshot,
    Show,
)


def own_folder():
    """pvpython tells a script its file; ParaView's window does not, but it was called with it, or works in that folder."""
    calls = [__file__] if "__file__" in globals() else []
    try:
        with open("/proc/self/cmdline") as file:
            words = file.read().split("\0")
        calls += [word.partition("=")[2] for word in words if word.startswith("--script=")]
        calls += [after for word, after in zip(words, words[1:]) if word == "--script"]
    except OSError:
        pass  # of another system
    folders = [os.path.dirname(os.path.abspath(call)) for call in calls] + [os.getcwd()]
    for folder in folders:
        if os.path.exists(os.path.join(folder, "case.pvd")):
            return folder
    raise RuntimeError("no case.pvd in '%s': call it as paraview --script=FOLDER/view.py" % "', '".join(folders))


FOLDER = own_folder()


def names():
    """Of all that there is, in the order of case.pvd."""
    found = []
    for entry in xml.etree.ElementTree.parse(os.path.join(FOLDER, "case.pvd")).iter("DataSet"):
        if entry.get("name") not in found:
            found.append(entry.get("name"))
    return found


def opened(name, view):
    reader = PVDReader(FileName=os.path.join(FOLDER, "data", name + ".pvd"))
    RenameSource(name, reader)
    display = Show(reader, view)
    display.ColorArrayName = ["POINTS", ""]
    return reader, display


def coloured(display, red, green, blue):
    display.DiffuseColor = display.AmbientColor = [red, green, blue]


def show(view):
    all_names = names()
    for name in all_names:
        reader, display = opened(name, view)
        if name == "water":
            display.PointSize = 4.0
            ColorBy(display, ("POINTS", "velocity", "Magnitude"))
            GetColorTransferFunction("velocity").ApplyPreset("Cool to Warm", True)
            display.RescaleTransferFunctionToDataRangeOverTime()
            display.SetScalarBarVisibility(view, True)
            if "surface" in all_names:
                Hide(reader, view)
        elif name == "surface":
            coloured(display, 0.10, 0.42, 0.75)
            display.Opacity = 0.7
            display.Specular = 0.8
        elif name == "spray":
            coloured(display, 0.8, 0.9, 1.0)
            display.PointSize = 3.0
        elif name == "tank":
            coloured(display, 0.55, 0.7, 0.8)
            display.Opacity = 0.15
        elif name.startswith("body_"):
            coloured(display, 0.95, 0.58, 0.15)
        else:
            coloured(display, *((0.1, 0.7, 0.2) if name == "gauges" else (0.9, 0.1, 0.1)))
            display.PointSize = 9.0


def look(view):
    """From above and a side."""
    view.CameraFocalPoint, view.CameraPosition, view.CameraViewUp = [0, 0, 0], [-0.32, -0.86, 0.41], [0, 0, 1]
    ResetCamera(view)


def options_of(arguments):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--png", metavar="FILE", help="write a picture, and end")
    parser.add_argument("--at", metavar="S", type=float, help="of the picture: simulated time, s (the last)")
    parser.add_argument("--size", default="1280x720", help="of the picture, pixels")
    return parser.parse_args(arguments)


def main(arguments):
    options = options_of(arguments)
    view = GetActiveViewOrCreate("RenderView")
    show(view)
    scene = GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    if options.png:
        view.ViewSize = [int(number) for number in options.size.split("x")]
        times = list(scene.TimeKeeper.TimestepValues)
        scene.AnimationTime = times[-1] if options.at is None else min(times, key=lambda time: abs(time - options.at))
    look(view)
    Render(view)
    if options.png:
        SaveScreenshot(options.png, view, ImageResolution=view.ViewSize)


main(sys.argv[1:] if "__file__" in globals() else [])  # of the window the words are its own

"""Draws tank, bodies and water by VTK into pictures in memory."""

import numpy

from wavetank import Failure
from wavetank.display import INSTALL

try:
    import vtkmodules.vtkRenderingFreeType  # noqa: F401: what text is drawn by
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401: what all is drawn by
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkCommonMath import vtkMatrix4x4
    from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
    from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
    from vtkmodules.vtkRenderingCore import vtkActor, vtkLight, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkTextActor, vtkWindowToImageFilter
    from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLSphereMapper
except ImportError as error:
    raise Failure("pictures are drawn by VTK, which is not there (%s): %s (Debian: python3-vtk9)" % (error, INSTALL))

# red, green, blue
SKY, HORIZON = (0.56, 0.67, 0.79), (0.86, 0.90, 0.94)
WATER = (0.10, 0.42, 0.75)
BODY, BODY_EDGE = (0.95, 0.58, 0.15), (0.35, 0.20, 0.05)
MOORING = (0.45, 0.36, 0.05)
GLASS, GLASS_EDGE = (0.80, 0.86, 0.90), (0.25, 0.30, 0.36)
FLOOR = (0.74, 0.74, 0.73)
INK = (0.08, 0.10, 0.14)
SCALES = {  # of what water is coloured by: low to high
    "speed": [(0.05, 0.26, 0.60), (0.09, 0.43, 0.78), (0.25, 0.64, 0.91), (0.64, 0.86, 0.97), (1.0, 1.0, 1.0)],
    "pressure": [(0.70, 0.90, 0.98), (0.25, 0.65, 0.90), (0.08, 0.38, 0.75), (0.10, 0.15, 0.50), (0.30, 0.05, 0.40)],
}
# Water shows what is below it where it is looked at from above, and the sky at a slant: Schlick's term for water, 0.02 head on.
FRESNEL = """//VTK::Light::Impl
  float slant = pow(1.0 - clamp(abs(normalVCVSOutput.z), 0.0, 1.0), 5.0);
  float mirrored = 0.02 + 0.98 * slant;
  gl_FragData[0].rgb = mix(gl_FragData[0].rgb, vec3(%.3f, %.3f, %.3f), 0.8 * mirrored);
  gl_FragData[0].a = mix(gl_FragData[0].a, 1.0, mirrored);
""" % (
    SKY
)


def polygons(points, size, corners=None):
    """Of points in a row, or of those that `corners` names, `size` to a cell; 0: all in one cell of vertices."""
    data = vtkPolyData()
    holder = vtkPoints()
    holder.SetData(numpy_to_vtk(numpy.ascontiguousarray(points, dtype=numpy.float32), deep=True))
    data.SetPoints(holder)
    corners = numpy.arange(len(points)) if corners is None else corners
    count = len(corners)
    offsets = numpy.arange(0, count + 1, size) if size else numpy.array([0, count])
    cells = vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(offsets.astype(numpy.int64), deep=True), numpy_to_vtkIdTypeArray(corners.astype(numpy.int64), deep=True))
    {0: data.SetVerts, 2: data.SetLines, 3: data.SetPolys}[size](cells)
    return data


def shared(corners):
    """Points that are there once, and the place of each corner among them."""
    exact = numpy.ascontiguousarray(corners, dtype=numpy.float32)
    keys = exact.view(numpy.dtype((numpy.void, 12))).ravel()
    _, first, places = numpy.unique(keys, return_index=True, return_inverse=True)
    return exact[first], places


def matrix_of(position, quaternion):
    x, y, z, w = quaternion
    rotation = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return numpy.vstack([numpy.column_stack([rotation, position]), [0, 0, 0, 1]])


def place(actor, matrix):
    held = vtkMatrix4x4()
    held.DeepCopy(numpy.asarray(matrix, dtype=float).ravel())
    actor.SetUserMatrix(held)


def set_lines(actor, points):
    """Two points a line."""
    actor.GetMapper().SetInputData(polygons(points, 2))


class Stage:
    """What is seen, from a camera. size: (width, height), pixels."""

    def __init__(self, size, camera):
        self.size = size
        self.renderer = vtkRenderer()
        self.renderer.GradientBackgroundOn()
        self.renderer.SetBackground(*HORIZON)
        self.renderer.SetBackground2(*SKY)
        self.window = vtkRenderWindow()
        self.window.OffScreenRenderingOn()
        self.window.SetSize(*size)
        self.window.SetMultiSamples(4)
        self.window.AddRenderer(self.renderer)
        self._aim(camera)
        self._light()

    def _aim(self, camera):
        view = self.renderer.GetActiveCamera()
        view.SetViewAngle(45.0)
        view.SetPosition(*camera.eye)
        view.SetFocalPoint(*camera.target)
        view.SetViewUp(*camera.up)
        if camera.is_flat:
            view.ParallelProjectionOn()
            view.SetParallelScale(numpy.tan(numpy.radians(22.5)) * float(numpy.linalg.norm(camera.eye - camera.target)))
        self.eye = numpy.array(camera.eye)

    def _light(self):
        """The sun over the viewer's left shoulder, and the sky from above."""
        self.renderer.AutomaticLightCreationOff()
        for position, strength, follows in (((-0.6, 1.0, 0.8), 0.85, True), ((0.0, 0.0, 1.0), 0.35, False), ((0.8, -0.2, 0.6), 0.25, True)):
            light = vtkLight()
            if follows:
                light.SetLightTypeToCameraLight()
            light.SetPosition(*position)
            light.SetFocalPoint(0, 0, 0)
            light.SetIntensity(strength)
            self.renderer.AddLight(light)

    def add(self, data, colour, opacity=1.0, width=1.0):
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(data)
        actor = vtkActor()
        actor.SetMapper(mapper)
        look = actor.GetProperty()
        look.SetColor(*colour)
        look.SetOpacity(opacity)
        look.SetLineWidth(width)
        look.SetAmbient(0.25)
        look.SetDiffuse(0.8)
        self.renderer.AddActor(actor)
        return actor

    def add_mesh(self, points, colour, opacity=1.0):
        data = polygons(points, 3)
        actor = self.add(data, colour, opacity)
        look = actor.GetProperty()
        look.SetInterpolationToFlat()
        look.SetAmbient(0.55)
        look.SetDiffuse(0.6)
        return actor

    def add_edges(self, points, colour, width):
        actor = self.add(polygons(points, 2), colour, 1.0, width)
        actor.GetProperty().LightingOff()
        return actor

    def add_lines(self, colour, width):
        """Lines that change: see set_lines."""
        return self.add_edges(numpy.empty((0, 3)), colour, width)

    def add_text(self, place, height):
        text = vtkTextActor()
        text.GetTextProperty().SetFontSize(height)
        text.GetTextProperty().SetColor(*INK)
        text.GetTextProperty().SetFontFamilyToArial()
        text.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
        text.SetPosition(*place)
        self.renderer.AddActor2D(text)
        return text

    def add_scale(self, table, title):
        bar = vtkScalarBarActor()
        bar.SetLookupTable(table)
        bar.SetNumberOfLabels(5 if self.size[0] > 700 else 3)
        bar.SetOrientationToHorizontal()
        bar.SetPosition(0.66, 0.015)
        bar.SetWidth(0.32)
        bar.SetHeight(0.07)
        self.add_text((0.66, 0.09), max(10, self.size[1] // 45)).SetInput(title)
        bar.SetLabelFormat("%.5g")
        bar.UnconstrainedFontSizeOn()
        labels = bar.GetLabelTextProperty()
        labels.SetColor(*INK)
        labels.SetFontSize(max(10, self.size[1] // 50))
        labels.ItalicOff()
        labels.BoldOff()
        labels.ShadowOff()
        self.renderer.AddActor2D(bar)

    def draw(self):
        """The picture: rows from the top, of red, green and blue."""
        self.renderer.ResetCameraClippingRange()
        self.window.Render()
        grabbing = vtkWindowToImageFilter()
        grabbing.SetInput(self.window)
        grabbing.ReadFrontBufferOff()
        grabbing.Update()
        image = grabbing.GetOutput()
        width, height, _ = image.GetDimensions()
        return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[::-1, :, :3].copy()

    def end(self):
        self.window.Finalize()


class SurfaceLook:
    """Water as a surface that light falls through."""

    def __init__(self, stage, spray_radius):
        self._actor = stage.add(vtkPolyData(), WATER, 0.72)
        look = self._actor.GetProperty()
        look.SetInterpolationToPhong()
        look.SetAmbient(0.32)
        look.SetDiffuse(0.7)
        look.SetSpecular(0.9)
        look.SetSpecularPower(60)
        look.SetSpecularColor(1, 1, 1)
        self._actor.GetShaderProperty().AddFragmentShaderReplacement("//VTK::Light::Impl", False, FRESNEL, False)
        self._actor.ForceTranslucentOn()
        self._spray = SphereLook(stage, spray_radius)
        self.actors = [self._actor, self._spray.actor]

    def show(self, corners, spray, eye):
        """eye: where the camera is, in the frame of the corners: what is translucent is drawn from behind."""
        if len(corners):
            points, places = shared(corners)
            middles = corners.reshape(-1, 3, 3).mean(axis=1)
            places = places.reshape(-1, 3)[numpy.argsort(-numpy.sum((middles - eye) ** 2, axis=1), kind="stable")].ravel()
            normals = vtkPolyDataNormals()
            normals.SetInputData(polygons(points, 3, places))
            normals.SplittingOff()
            normals.ConsistencyOff()
            normals.Update()
            self._actor.GetMapper().SetInputData(normals.GetOutput())
        else:
            self._actor.GetMapper().SetInputData(vtkPolyData())
        self._spray.show(spray)


class SphereLook:
    """Particles as balls, of one colour or coloured by a value of theirs; is_flat: without light and shade, as a section is drawn."""

    def __init__(self, stage, radius, table=None, is_flat=False):
        self._mapper = vtkOpenGLSphereMapper()
        self._mapper.SetRadius(radius)
        if table is not None:
            self._mapper.SetLookupTable(table)
            self._mapper.UseLookupTableScalarRangeOn()
        else:
            self._mapper.ScalarVisibilityOff()
        self._mapper.SetInputData(vtkPolyData())
        self.actor = vtkActor()
        self.actor.SetMapper(self._mapper)
        look = self.actor.GetProperty()
        look.SetColor(0.80, 0.91, 0.98)
        look.SetAmbient(0.3)
        look.SetDiffuse(0.75)
        look.SetSpecular(0.25)
        look.SetSpecularPower(30)
        if is_flat:
            look.LightingOff()
        stage.renderer.AddActor(self.actor)
        self.actors = [self.actor]

    def show(self, points, values=None):
        data = polygons(points, 0) if len(points) else vtkPolyData()
        if values is not None and len(points):
            data.GetPointData().SetScalars(numpy_to_vtk(numpy.ascontiguousarray(values, dtype=numpy.float32), deep=True))
        self._mapper.SetInputData(data)


def colour_table(name, low, high):
    steps = 256
    stops = numpy.array(SCALES[name])
    table = vtkLookupTable()
    table.SetNumberOfTableValues(steps)
    table.SetRange(low, high)
    for n in range(steps):
        at = n / (steps - 1) * (len(stops) - 1)
        table.SetTableValue(n, *[numpy.interp(at, range(len(stops)), stops[:, k]) for k in range(3)], 1.0)
    return table

"""Meshes and fields of pictures, and dimensions measured on them."""

import functools

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkPlane, vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkCutter
from vtkmodules.vtkFiltersVerdict import vtkMeshQuality
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from .files import PictureCheck, refuse

# faces of a hexahedron, corners in order as seen from outside
HEXAHEDRON_FACES = np.array([(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2),
                             (0, 3, 2, 1), (4, 5, 6, 7)])
HEXAHEDRON_EDGES = np.array([(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4),
                             (1, 5), (2, 6), (3, 7)])
TOLERANCE = 1e-3  # within which places are the same [m]
SCATTER = np.random.default_rng(1).integers(2**62, size=3)  # factors that spread keys over 64 bits


def keys_of_sets(numbers):
    """A number for each row of small numbers, independent of their order in the row."""
    mixed = (numbers + 1) * SCATTER[0]
    mixed ^= mixed >> 29
    return (mixed * SCATTER[1]).sum(axis=-1)


def centre_keys(corners):
    """A number for the place of the middle of each face (n, 4, 3), to the centimetre,
    the same in all pictures of a run."""
    # the offset keeps round coordinates away from the limits of the intervals
    return np.floor(100. * corners.mean(axis=1) + 0.137).astype(np.int64) @ SCATTER


def point_keys(points):
    """A number for each place (n, 3), as centre_keys."""
    return np.floor(100. * points + 0.137).astype(np.int64) @ SCATTER


def occur_once(keys):
    """Whether a number of a list (n) occurs in it once."""
    _, inverse, counts = np.unique(keys, return_inverse=True, return_counts=True)
    return counts[inverse.reshape(-1)] == 1


def at_hanging_nodes(places):
    """Whether an edge (n, 2) or a face (n, 4) of a list, by the places of its corners, is halved
    into others of the list, or is one of these: each of them has a corner of the larger
    one, and opposite to it all have the same node."""
    n, corners = places.shape
    corner, opposite = places.reshape(-1), np.roll(places, corners // 2, axis=1).reshape(-1)
    order = np.argsort(corner, kind="stable")
    first = np.searchsorted(corner[order], corner)
    numbers = np.searchsorted(corner[order], corner, side="right") - first
    # all pairs of one that may be halved and one with the same place at a corner
    larger = np.repeat(np.arange(n * corners), numbers)
    smaller = order[np.arange(len(larger)) + np.repeat(first - np.cumsum(numbers) + numbers, numbers)]
    pair = larger // corners * (places.max(initial=0) + 1) + opposite[smaller]
    at_corners = np.unique(pair * corners + larger % corners) // corners
    pairs, found = np.unique(at_corners, return_counts=True)
    halved = np.isin(pair, pairs[found == corners])
    result = np.zeros(n, bool)
    result[larger[halved] // corners] = result[smaller[halved] // corners] = True
    return result


class Fields(dict):
    """Values at corners by the name of the field."""

    def __init__(self, file, values):
        super().__init__(values)
        self.file = file

    def __missing__(self, name):
        refuse(self.file, f'has no field "{name}"')


class Grid:
    """A file of hexahedra or quadrilaterals: corners, cells and values at corners.

    In the files no two cells share points, so values may jump between cells.
    """

    def __init__(self, file):
        self.file = file
        check = PictureCheck(file)
        messages = vtkStringOutputWindow()
        vtkOutputWindow.SetInstance(messages)
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(file))
        reader.Update()
        vtkOutputWindow.SetInstance(None)
        self.vtk = reader.GetOutput()
        if messages.GetOutput() or self.vtk.GetNumberOfPoints() == 0:
            check.refuse("its data cannot be read")
        self.points = vtk_to_numpy(self.vtk.GetPoints().GetData()).astype(float)
        connectivity = vtk_to_numpy(self.vtk.GetCells().GetConnectivityArray())
        n_cells = self.vtk.GetNumberOfCells()
        if len(connectivity) not in (4 * n_cells, 8 * n_cells):
            check.refuse("its cells are no hexahedra or quadrilaterals")
        self.cells = connectivity.reshape(n_cells, -1)
        if self.cells.min() < 0 or self.cells.max() >= len(self.points):
            check.refuse("its cells have corners that are no points of it")
        data = self.vtk.GetPointData()
        self.values = Fields(file, {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
                                    for i in range(data.GetNumberOfArrays())})

    def names(self, kind):
        """Names that the numbers of a field "material", "face_set" and so on stand for."""
        texts = self.vtk.GetFieldData().GetAbstractArray(kind + "_names")
        if texts is None:
            refuse(self.file, f'has no list "{kind}_names"')
        # written with quotation marks
        return [texts.GetValue(i).strip('"') for i in range(texts.GetNumberOfValues())]

    def of(self, kind, name):
        """Numbers of the cells that belong to a material, face set or interface."""
        number = self.names(kind).index(name)
        return np.flatnonzero(self.values[kind][self.cells[:, 0]] == number)

    @functools.cached_property
    def places(self):
        """For each point a number that all points at the same place share."""
        keys = np.round(self.points / TOLERANCE).astype(np.int64) @ SCATTER
        return np.unique(keys, return_inverse=True)[1].reshape(-1)

    def faces(self, cells):
        """Corners (cells * 6, 4) of all faces of some hexahedra."""
        return self.cells[cells][:, HEXAHEDRON_FACES].reshape(-1, 4)

    def face_keys(self, faces):
        """A number for each face (n, 4) that all faces at the same place share."""
        return keys_of_sets(self.places[faces])

    def outer_faces(self, cells, among=None):
        """Corners (n, 4) of the faces of some hexahedra that are shared with no other
        cell @p among these (by default the same); both sides of a joint are one place."""
        among = cells if among is None else among
        faces = self.faces(among)
        alone = np.flatnonzero(occur_once(self.face_keys(faces)))
        alone = alone[~at_hanging_nodes(self.places[faces[alone]])]
        return faces[alone[np.isin(among, cells)[alone // len(HEXAHEDRON_FACES)]]]

    @functools.cached_property
    def quality(self):
        """Scaled Jacobian of hexahedra: 1 for a brick, 0 for a flat corner (Knupp 2000)."""
        filter = vtkMeshQuality()
        filter.SetInputData(self.vtk)
        filter.SetHexQualityMeasureToScaledJacobian()
        filter.Update()
        return vtk_to_numpy(filter.GetOutput().GetCellData().GetArray("Quality"))

    def edges(self, cells):
        """Lengths of the edges of some hexahedra [m]."""
        corners = self.points[self.cells[cells]]
        return np.linalg.norm(corners[:, HEXAHEDRON_EDGES[:, 1]] - corners[:, HEXAHEDRON_EDGES[:, 0]],
                              axis=2)

    def volumes(self, cells):
        """Volumes of hexahedra [m3], from the fluxes of x/3 through their faces."""
        corners = self.points[self.cells[cells]][:, HEXAHEDRON_FACES]
        middle = corners.mean(axis=2)
        return np.einsum("cfd,cfd->c", middle, area_vectors(corners)) / 3.


    def cut(self, at, axis=0):
        """Polygons where the plane normal to an axis cuts cells, in coordinates of the other
        two axes, and numbers of these cells."""
        numbered = vtkUnstructuredGrid()
        numbered.CopyStructure(self.vtk)
        numbers = numpy_to_vtk(np.arange(len(self.cells)), deep=True)
        numbers.SetName("number")
        numbered.GetCellData().AddArray(numbers)
        plane = vtkPlane()
        plane.SetOrigin(*(at * np.eye(3)[axis]))
        plane.SetNormal(*np.eye(3)[axis])
        cutter = vtkCutter()
        cutter.SetInputData(numbered)
        cutter.SetCutFunction(plane)
        cutter.GenerateTrianglesOff()
        cutter.Update()
        cut = cutter.GetOutput()
        if cut.GetNumberOfCells() == 0:
            return [], np.zeros(0, int)
        points = np.delete(vtk_to_numpy(cut.GetPoints().GetData()), axis, axis=1)
        corners = vtk_to_numpy(cut.GetPolys().GetConnectivityArray())
        ends = vtk_to_numpy(cut.GetPolys().GetOffsetsArray())[1:-1]
        return (np.split(points[corners], ends),
                vtk_to_numpy(cut.GetCellData().GetArray("number")))


def area_vectors(corners):
    """Normals times areas of quadrilaterals (..., 4, 3)."""
    return 0.5 * np.cross(corners[..., 2, :] - corners[..., 0, :],
                          corners[..., 3, :] - corners[..., 1, :])


class Dam:
    """The cells of the dam in a picture, and its faces.

    +y is upstream, +x the left bank, +z up, as everywhere in the program.
    """

    def __init__(self, grid, materials):
        self.grid = grid
        self.cells = np.concatenate([grid.of("material", name) for name in materials])
        self.others = np.setdiff1d(np.arange(len(grid.cells)), self.cells)
        self.points = grid.points[grid.cells[self.cells]].reshape(-1, 3)
        self.top, self.bottom = self.points[:, 2].max(), self.points[:, 2].min()
        self.height = self.top - self.bottom

    @functools.cached_property
    def exposed(self):
        """Corners of the faces that border neither on rock nor on water nor on the dam."""
        return self.grid.outer_faces(self.cells, np.arange(len(self.grid.cells)))

    @functools.cached_property
    def foundation(self):
        """Numbers of the points of the dam where it meets the rock."""
        mine = np.unique(self.grid.cells[self.cells])
        return mine[np.isin(self.grid.places[mine], self.grid.places[self.grid.cells[self.others]])]

    def _unit_normals(self):
        normals = area_vectors(self.grid.points[self.exposed])
        return normals / np.linalg.norm(normals, axis=1)[:, None]

    @functools.cached_property
    def crest(self):
        """Faces of the crest: level and at the top."""
        level = self.grid.points[self.exposed][:, :, 2] > self.top - 1e-3 * self.height
        return self.exposed[level.all(axis=1)]

    def side(self, name):
        """Corners of the upstream or the downstream face."""
        normals = self._unit_normals()
        sign = 1. if name == "upstream" else -1.
        # the sides of a slice of a dam face the banks
        along_river = (sign * normals[:, 1] > 0.1) & (np.abs(normals[:, 2]) < 0.99)
        return self.exposed[along_river]

    @functools.cached_property
    def crest_length(self):
        """Length along the middle of a crest of constant width [m]: a strip, straight or
        curved, of length L and width w has the area L w and the perimeter 2 L + 2 w."""
        corners = self.grid.points[self.crest]
        area = np.linalg.norm(area_vectors(corners), axis=1).sum()
        places = self.grid.places[self.crest]
        edges = np.stack([places, np.roll(places, -1, axis=1)], axis=2).reshape(-1, 2)
        lengths = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).reshape(-1)
        alone = np.flatnonzero(occur_once(keys_of_sets(edges)))
        outline = lengths[alone[~at_hanging_nodes(edges[alone])]].sum()
        half = 0.5 * outline
        return 0.5 * (half + np.sqrt(max(half**2 - 4. * area, 0.)))

    @functools.cached_property
    def crest_width(self):
        corners = self.grid.points[self.crest]
        return np.linalg.norm(area_vectors(corners), axis=1).sum() / self.crest_length

    @functools.cached_property
    def volume(self):
        return self.grid.volumes(self.cells).sum()

    @property
    def is_slice(self):
        """Whether this is a slice of a dam, not one from bank to bank."""
        return np.ptp(self.points[:, 0]) < 0.5 * self.height

    @functools.cached_property
    def crown(self):
        """Polygons (y, z) of the section in the middle, and numbers of their cells."""
        xs = self.points[:, 0]
        # beside the middle, which may be a boundary of cells
        return self.section(0.5 * (xs.min() + xs.max()) + 1e-3 * np.ptp(xs))

    def section(self, at, axis=0):
        """Polygons of the dam in the plane normal to an axis, and numbers of their cells."""
        polygons, cells = self.grid.cut(at, axis)
        mine = np.isin(cells, self.cells)
        return [polygon for polygon, own in zip(polygons, mine) if own], cells[mine]

    def cells_through(self, share):
        """Number of cells through the thickness of the section in the middle, at a share of
        the height."""
        at = self.bottom + share * self.height + 1e-4 * self.height
        return sum(p[:, 1].min() < at < p[:, 1].max() for p in self.crown[0])

    @functools.cached_property
    def slenderness(self):
        """Lombardi's F^2/(V H), F the area of the middle surface [-]."""
        area = np.mean([np.linalg.norm(area_vectors(self.grid.points[self.side(name)]), axis=1).sum()
                        for name in ("upstream", "downstream")])
        return area**2 / (self.volume * self.height)

    @functools.cached_property
    def crest_line(self):
        """x and length from the middle [m] of the upstream edge of the crest."""
        points = self.grid.points[self.side("upstream")].reshape(-1, 3)
        points = points[points[:, 2] > self.top - 1e-3 * self.height]
        xs, first = np.unique(np.round(points[:, 0], 3), return_index=True)
        along = np.concatenate([[0.], np.cumsum(np.hypot(np.diff(xs),
                                                         np.diff(points[first, 1])))])
        return xs, along - np.interp(0.5 * (xs[0] + xs[-1]), xs, along)

    def developed(self, x):
        """Length along the crest [m] above or below a place x."""
        return np.interp(x, *self.crest_line)


@functools.lru_cache(maxsize=None)
def grid_of(run, name):
    """A picture in the folder of a run, or None."""
    return Grid(run.folder / name) if run.has(name) else None


@functools.lru_cache(maxsize=None)
def dam_in(run, name):
    """The dam in a picture of the whole model."""
    grid = grid_of(run, name)
    return Dam(grid, dam_materials(run, grid.names("material")))


def dam_of(run):
    """The dam in the last picture of the whole model that a run has written, or None."""
    of_fields = [file for _, file in run.pictures("fields")[-1:]]
    files = [name for name in ("envelopes.vtu", *of_fields, "modes.vtu") if run.has(name)]
    return dam_in(run, files[0]) if files else None


def dam_materials(run, names):
    """Names of the materials of the dam: those with dam, block or concrete, and without
    rock, in their names or cell sets, or else the first material."""
    entries = dict(run.objects("Materials"))

    def is_called(name, *words):
        text = f"{name}, {entries.get(name, {}).get('Cell sets', '')}".lower()
        return any(word in text for word in words)

    return [name for name in names if is_called(name, "dam", "block", "concrete")
            and not is_called(name, "rock", "foundation")] or names[:1]

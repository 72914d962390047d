"""Plane elasticity by quadratic finite elements on the triangles of a Gmsh mesh: an independent solution."""
import numpy
import scipy.sparse
import scipy.sparse.linalg


def read_mesh(path):
    """Positions, triangles and the edges of each named curve of an ASCII mesh of version 2.2."""
    lines = iter(path.read_text(encoding="utf-8").splitlines())
    names, points, triangles, edges = {}, {}, [], {}
    for line in lines:
        if line == "$PhysicalNames":
            for _ in range(int(next(lines))):
                dim, tag, name = next(lines).split(maxsplit=2)
                if dim == "1":
                    names[int(tag)] = name.strip('"')
        elif line == "$Nodes":
            for _ in range(int(next(lines))):
                tag, x, y, _ = next(lines).split()
                points[int(tag)] = (float(x), float(y))
        elif line == "$Elements":
            for _ in range(int(next(lines))):
                _, kind, tags, *rest = map(int, next(lines).split())
                if kind == 2:
                    triangles.append(rest[tags:])
                elif kind == 1:
                    edges.setdefault(names[rest[0]], []).append(rest[tags:])
    used = sorted({node for triangle in triangles for node in triangle})
    number = {tag: i for i, tag in enumerate(used)}
    return (numpy.array([points[tag] for tag in used]),
            numpy.array([[number[tag] for tag in triangle] for triangle in triangles]),
            {name: [[number[tag] for tag in edge] for edge in some] for name, some in edges.items()})


class PlaneElasticity:
    """A body that fills a mesh, held and loaded on its named curves. Nodes are vertices, then middles of edges."""

    def __init__(self, path, young, poisson, state):
        self.vertices, triangles, self.edges = read_mesh(path)
        self.middles, elements = {}, []
        for triangle in triangles:
            elements.append([*triangle, *(self.middle(triangle[i], triangle[(i + 1) % 3]) for i in range(3))])
        if state == "plane_strain":
            young, poisson = young / (1 - poisson**2), poisson / (1 - poisson)
        law = young / (1 - poisson**2) * numpy.array([[1, poisson, 0], [poisson, 1, 0], [0, 0, (1 - poisson) / 2]])
        self.size = 2 * (len(self.vertices) + len(self.middles))
        self.force = numpy.zeros(self.size)
        self.elements = [self.element(nodes, law) for nodes in elements]
        self.held = {}

    def middle(self, a, b):
        key = (min(a, b), max(a, b))
        return self.middles.setdefault(key, len(self.vertices) + len(self.middles))

    def element(self, nodes, law):
        """Unknowns, stiffness and area of a triangle; the integrand is quadratic, for which the edges' middles do."""
        x = self.vertices[nodes[:3]]
        map_ = numpy.array([x[1] - x[0], x[2] - x[0]])
        area = 0.5 * abs(numpy.linalg.det(map_))
        slopes = numpy.linalg.inv(map_) @ numpy.array([[-1, 1, 0], [-1, 0, 1]])  # of the barycentric coordinates
        stiffness = numpy.zeros((12, 12))
        for i in range(3):
            bary = numpy.full(3, 0.5)
            bary[(i + 2) % 3] = 0
            gradient = numpy.empty((2, 6))
            for j in range(3):
                k = (j + 1) % 3
                gradient[:, j] = (4 * bary[j] - 1) * slopes[:, j]
                gradient[:, 3 + j] = 4 * (bary[j] * slopes[:, k] + bary[k] * slopes[:, j])
            strain = numpy.zeros((3, 12))
            strain[0, 0::2], strain[1, 1::2] = gradient
            strain[2, 0::2], strain[2, 1::2] = gradient[1], gradient[0]
            stiffness += area / 3 * strain.T @ law @ strain
        return numpy.array([[2 * n, 2 * n + 1] for n in nodes]).ravel(), stiffness, area

    def pull(self, name, traction):
        for a, b in self.edges[name]:
            length = numpy.linalg.norm(self.vertices[a] - self.vertices[b])
            for node, share in ((a, 1 / 6), (b, 1 / 6), (self.middle(a, b), 4 / 6)):
                self.force[2 * node:2 * node + 2] += share * length * numpy.array(traction)

    def weigh(self, force):
        for unknowns, _, area in self.elements:
            self.force[unknowns[6:]] += numpy.tile(force, 3) * area / 3

    def hold(self, name, axis, value=0.0):
        for a, b in self.edges[name]:
            for node in (a, b, self.middle(a, b)):
                self.held[2 * node + axis] = value

    def solve(self):
        """Displacements at the vertices, (vertices, 2)."""
        rows = numpy.concatenate([numpy.repeat(unknowns, 12) for unknowns, _, _ in self.elements])
        columns = numpy.concatenate([numpy.tile(unknowns, 12) for unknowns, _, _ in self.elements])
        values = numpy.concatenate([stiffness.ravel() for _, stiffness, _ in self.elements])
        matrix = scipy.sparse.csr_matrix((values, (rows, columns)), shape=(self.size, self.size))
        result = numpy.zeros(self.size)
        held = numpy.array(sorted(self.held))
        result[held] = [self.held[unknown] for unknown in held]
        free = numpy.setdiff1d(numpy.arange(self.size), held)
        load = self.force - matrix @ result
        result[free] = scipy.sparse.linalg.spsolve(matrix[free][:, free].tocsc(), load[free])
        return result.reshape(-1, 2)[:len(self.vertices)]

    def at(self, displacements, place):
        """Displacement of the vertex at a place."""
        distance = numpy.linalg.norm(self.vertices - numpy.array(place), axis=1)
        assert distance.min() < 1e-9, place
        return displacements[distance.argmin()]

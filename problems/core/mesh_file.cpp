#include "problems/core/mesh_file.hpp"

#include <fstream>
#include <map>
#include <mutex>

#include <fmt/format.h>
#include <gmsh.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

[[noreturn]] void fail(const std::string& what) { throw CaseError(what); }

/// Starts the Gmsh library, silenced, and ends it however the scope is left. The library has one
/// global state: hold the mutex around it.
class GmshSession {
 public:
  GmshSession() {
    constexpr bool read_config_files = false;
    gmsh::initialize(0, nullptr, read_config_files);
    gmsh::option::setNumber("General.Terminal", 0);
  }
  ~GmshSession() { gmsh::finalize(); }
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;
};

/// Calls `visit(type, nodes)` for every element of a dimension, or of one entity of it.
template <class Visit>
void visit_elements(int dim, int entity, Visit visit) {
  std::vector<int> types;
  std::vector<Tags> element_tags, node_tags;
  gmsh::model::mesh::getElements(types, element_tags, node_tags, dim, entity);
  for (std::size_t t = 0; t < types.size(); ++t) {
    const std::size_t count = element_tags[t].size();
    if (count == 0) continue;
    const auto length = static_cast<std::ptrdiff_t>(node_tags[t].size() / count);
    for (auto node = node_tags[t].begin(); node != node_tags[t].end(); node += length) {
      visit(types[t], Tags(node, node + length));
    }
  }
}

/// The highest dimension of the elements in an open Gmsh model.
int highest_dimension() {
  for (int dim = 3; dim > 1; --dim) {
    std::vector<int> types;
    gmsh::model::mesh::getElementTypes(types, dim);
    if (!types.empty()) return dim;
  }
  return 1;
}

/// Everything in an open Gmsh model that is needed of a dimension.
Mesh read_model(int dim) {
  Mesh mesh;
  mesh.dimension = dim;
  Tags tags;
  std::vector<double> coordinates, parametric;
  gmsh::model::mesh::getNodes(tags, coordinates, parametric, -1, -1, false, false);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    mesh.nodes[tags[i]] = {coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]};
  }
  visit_elements(dim, -1, [&](int type, Tags nodes) {
    mesh.elements.push_back({type, std::move(nodes)});
  });
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups, dim - 1);
  for (const auto& [group_dim, tag] : groups) {
    BoundaryGroup group;
    gmsh::model::getPhysicalName(group_dim, tag, group.name);
    if (group.name.empty()) group.name = fmt::format("(number {}, unnamed)", tag);
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(group_dim, tag, entities);
    for (int entity : entities) {
      visit_elements(group_dim, entity,
                     [&](int, Tags nodes) { group.elements.push_back(std::move(nodes)); });
    }
    mesh.groups.push_back(std::move(group));
  }
  if (mesh.elements.empty()) {
    fail(fmt::format(
        "has no elements of dimension {}; mesh the geometry with gmsh -{} and put it into "
        "a physical group",
        dim, dim));
  }
  return mesh;
}

/// Opens a mesh in Gmsh and reads it, translating Gmsh's exceptions.
Mesh load(const std::string& path, std::optional<int> dimension) {
  std::ifstream file(path);
  if (!file) fail("cannot be opened; check the path and the permissions");
  // Gmsh runs any other file as a script.
  if (file.get() != '$')
    fail(
        "is not a Gmsh mesh: it does not begin with $MeshFormat; write it with "
        "gmsh -save or gmsh -2");
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  const GmshSession session;
  try {
    gmsh::open(path);
    return read_model(dimension ? *dimension : highest_dimension());
  } catch (const CaseError&) {
    throw;
  } catch (const std::exception& error) {
    fail(fmt::format("Gmsh cannot read it: {}", error.what()));
  } catch (const std::string& error) {  // Gmsh 4.8 throws bare strings and numbers
    fail(fmt::format("Gmsh cannot read it: {}", error));
  } catch (...) {
    fail("Gmsh cannot read it; check the mesh with the gmsh program");
  }
}

/// Sums of area vectors by node and side.
template <int Dim>
using NodeAreas = std::map<Tag, std::map<int, Point<Dim>>>;

/// The share that each node has in the boundary elements of each side.
template <int Dim>
NodeAreas<Dim> node_areas(const Topology<Dim>& topology) {
  NodeAreas<Dim> areas;
  for (const auto& [tags, facet] : topology.facets) {
    if (facet.side < 0) continue;
    for (Tag tag : tags) {
      areas[tag].try_emplace(facet.side, Point<Dim>::Zero()).first->second += facet.area;
    }
  }
  return areas;
}

template <int Dim>
PointCloud<Dim> cloud_of(const Domain<Dim>& domain, const Mesh& mesh) {
  Topology<Dim> topology = topology_of<Dim>(mesh);
  assign_sides(domain.sides(), mesh, topology);
  check_flat(mesh, topology, domain.reference_length());
  const NodeAreas<Dim> areas = node_areas(topology);
  CloudBuilder<Dim> builder;
  for (const auto& [tag, x] : topology.nodes) {
    std::vector<BoundaryMark<Dim>> marks;
    const auto own = areas.find(tag);
    if (own != areas.end()) {
      for (const auto& [side, area] : own->second) {
        if (!(area.norm() > 0)) {
          fail(
              fmt::format("node {} at {}: the normals on side '{}' cancel; give the two faces "
                          "different sides",
                          tag, format_point(x), domain.sides()[side]));
        }
        marks.push_back({side, area.normalized()});
      }
    }
    builder.add(x, std::move(marks));
  }
  return builder.finish(topology.measure);
}

}  // namespace

Mesh load_mesh(const std::string& path, std::optional<int> dimension) {
  try {
    return load(path, dimension);
  } catch (const CaseError& error) {
    throw CaseError(fmt::format("{}: {}", path, error.what()));
  }
}

template <int Dim>
PointCloud<Dim> read_mesh(const Domain<Dim>& domain, const std::string& path) {
  try {
    return cloud_of(domain, load(path, Dim));
  } catch (const CaseError& error) {
    throw CaseError(fmt::format("{}: {}", path, error.what()));
  }
}

template PointCloud<1> read_mesh(const Domain<1>&, const std::string&);
template PointCloud<2> read_mesh(const Domain<2>&, const std::string&);
template PointCloud<3> read_mesh(const Domain<3>&, const std::string&);

}  // namespace strongpoint

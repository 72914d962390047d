#include "studies/support/vtk.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "studies/support/output.hpp"

namespace strongpoint {
namespace {

constexpr std::uint8_t vertex_cell = 1;  // VTK_VERTEX
/// Longest part of a file name that one spec may take; nested rules are longer.
constexpr std::size_t longest_part = 60;

/// Base64 of some bytes. Source: RFC 4648, section 4.
std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = group << 8U | (j < count ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += j <= count ? digits[group >> (18 - 6 * j) & 63U] : '=';
    }
  }
  return text;
}

/// The bytes of an array behind their number, as VTK's inline binary format wants them.
template <class T>
std::string encoded(const std::vector<T>& values) {
  const std::uint64_t size = values.size() * sizeof(T);
  std::string bytes(sizeof(size) + size, '\0');
  std::memcpy(bytes.data(), &size, sizeof(size));
  if (size > 0) std::memcpy(bytes.data() + sizeof(size), values.data(), size);
  return base64(bytes);
}

template <class T>
std::string data_array(const char* type, const std::string& name, int components,
                       const std::vector<T>& values) {
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">\n{}\n"
      "</DataArray>\n",
      type, name, components, encoded(values));
}

/// A text as VTK stores it: the numbers of its characters, ended by zero.
std::string text_array(const char* name, const std::string& text) {
  std::string codes;
  for (const char c : text) codes += fmt::format("{} ", static_cast<unsigned char>(c));
  return fmt::format(
      "<Array type=\"String\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">\n{}0\n</Array>\n",
      name, codes);
}

/// Letters, digits, dots and underscores of a text, runs of anything else as one hyphen.
std::string safe(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_';
    if (plain) {
      result += c;
    } else if (!result.empty() && result.back() != '-') {
      result += '-';
    }
  }
  result.resize(std::min(result.size(), longest_part));
  while (!result.empty() && result.back() == '-') result.pop_back();
  return result;
}

/// Hash of a text. Source: Fowler, Noll and Vo, FNV-1a with 32 bits.
std::uint32_t hash_of(std::string_view text) {
  std::uint32_t hash = 2166136261U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  return hash;
}

std::string title_of(const CaseKey& key) {
  return fmt::format("{}, {}, stencil {}, cloud {}, level {}", key.problem, key.method, key.stencil,
                     key.cloud, key.level);
}

}  // namespace

NodeArray zone_array(const std::vector<Zone>& zones) {
  NodeArray array{"zone", {}};
  for (const Zone zone : zones) array.values.push_back(zone == Zone::boundary ? 1 : 0);
  return array;
}

template <int Dim>
std::string vtu_text(const Points<Dim>& nodes, const std::vector<NodeArray>& arrays,
                     const std::string& title) {
  const auto count = static_cast<std::size_t>(nodes.cols());
  std::vector<double> positions(3 * count);  // missing coordinates are zero
  std::vector<std::int64_t> connectivity(count), offsets(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int c = 0; c < Dim; ++c) {
      positions[3 * i + c] = nodes(c, static_cast<Eigen::Index>(i));
    }
    connectivity[i] = static_cast<std::int64_t>(i);
    offsets[i] = static_cast<std::int64_t>(i) + 1;
  }
  std::string data;
  for (const NodeArray& array : arrays) {
    if (array.values.size() != count) {
      throw std::invalid_argument(fmt::format("array {} holds {} numbers for {} nodes", array.name,
                                              array.values.size(), count));
    }
    data += data_array("Float64", array.name, 1, array.values);
  }
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" "
      "header_type=\"UInt64\">\n<UnstructuredGrid>\n<FieldData>\n{}</FieldData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>\n{}</PointData>\n"
      "<Points>\n{}</Points>\n<Cells>\n{}{}{}</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
      std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian",
      text_array("case", title), count, count, data,
      data_array("Float64", "positions", 3, positions),
      data_array("Int64", "connectivity", 1, connectivity),
      data_array("Int64", "offsets", 1, offsets),
      data_array("UInt8", "types", 1, std::vector<std::uint8_t>(count, vertex_cell)));
}

std::string vtu_path(const VtkOutput& output, const CaseKey& key) {
  const std::string rest = fmt::format("{}|{}", key.form, key.solver);
  const std::string level = key.level > 0 ? fmt::format("_{}", key.level) : "";
  return fmt::format("{}/{}_{}_{}_{}_{}{}_{:08x}.vtu", output.directory, output.study,
                     safe(key.problem), safe(key.method), safe(key.stencil), safe(key.cloud), level,
                     hash_of(title_of(key) + rest));
}

template <int Dim>
void write_vtu(const VtkOutput& output, const CaseKey& key, const Points<Dim>& nodes,
               const std::vector<NodeArray>& arrays) {
  write_whole(vtu_path(output, key), vtu_text<Dim>(nodes, arrays, title_of(key)));
}

template std::string vtu_text<1>(const Points<1>&, const std::vector<NodeArray>&,
                                 const std::string&);
template std::string vtu_text<2>(const Points<2>&, const std::vector<NodeArray>&,
                                 const std::string&);
template std::string vtu_text<3>(const Points<3>&, const std::vector<NodeArray>&,
                                 const std::string&);
template void write_vtu<1>(const VtkOutput&, const CaseKey&, const Points<1>&,
                           const std::vector<NodeArray>&);
template void write_vtu<2>(const VtkOutput&, const CaseKey&, const Points<2>&,
                           const std::vector<NodeArray>&);
template void write_vtu<3>(const VtkOutput&, const CaseKey&, const Points<3>&,
                           const std::vector<NodeArray>&);

}  // namespace strongpoint

#include "scenes/import/mesh.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <optional>
#include <unordered_map>

#include <fmt/format.h>

namespace sheave::import {
namespace {

constexpr std::size_t stl_head = 84;  // a title of 80 bytes, and the number of triangles
constexpr std::size_t stl_triangle = 50;

Error mesh_error(std::string message) { return Error{"", std::move(message)}; }

/// Collects triangles, with each point once.
class MeshBuilder {
 public:
  void add(const std::array<Vector3, 3>& corners) {
    add(std::array{index(corners[0]), index(corners[1]), index(corners[2])});
  }
  void add(const std::array<std::uint32_t, 3>& corners) {
    const auto [a, b, c] = corners;
    if (a != b && b != c && c != a) mesh.triangles.push_back(corners);
  }

  std::uint32_t index(const Vector3& point) {
    // -0 and 0 are the same place.
    const std::array<double, 3> key{point.x() + 0.0, point.y() + 0.0, point.z() + 0.0};
    const auto [place, is_new] =
        places_.try_emplace(key, static_cast<std::uint32_t>(mesh.points.size()));
    if (is_new) mesh.points.push_back(point);
    return place->second;
  }

  TriangleMesh mesh;

 private:
  struct Hash {
    std::size_t operator()(const std::array<double, 3>& key) const {
      std::uint64_t sum = 0;
      for (const double number : key) {
        sum = (sum ^ std::bit_cast<std::uint64_t>(number)) * 0x9E3779B97F4A7C15U;
        sum ^= sum >> 29U;
      }
      return static_cast<std::size_t>(sum);
    }
  };
  std::unordered_map<std::array<double, 3>, std::uint32_t, Hash> places_;
};

/// A number of 4 bytes, the lowest first, on any machine.
std::uint32_t word_at(std::string_view bytes, std::size_t place) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) {
    word = (word << 8U) | static_cast<unsigned char>(bytes[place + i]);
  }
  return word;
}

Result<TriangleMesh> read_binary_stl(std::string_view bytes) {
  const std::size_t count = word_at(bytes, stl_head - 4);
  if (count > most_triangles) {
    return mesh_error(fmt::format("{} triangles; at most {} are read", count, most_triangles));
  }
  MeshBuilder builder;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<Vector3, 3> corners;
    for (std::size_t k = 0; k < 9; ++k) {
      // The normal comes first; it follows from the corners.
      const std::size_t place = stl_head + stl_triangle * i + 12 + 4 * k;
      const auto value = static_cast<double>(std::bit_cast<float>(word_at(bytes, place)));
      if (!std::isfinite(value)) {
        return mesh_error(fmt::format("byte {}: a coordinate is not finite", place));
      }
      corners[k / 3][static_cast<int>(k % 3)] = value;
    }
    builder.add(corners);
  }
  return std::move(builder.mesh);
}

/// The words of a text, line by line.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  /// The next word of any line; empty at the end.
  std::string_view next() {
    while (!rest_.empty() && is_blank(rest_.front())) {
      line_ += rest_.front() == '\n' ? 1 : 0;
      rest_.remove_prefix(1);
    }
    return take();
  }
  /// The next word of this line; empty at its end.
  std::string_view next_in_line() {
    while (!rest_.empty() && rest_.front() != '\n' && is_blank(rest_.front())) {
      rest_.remove_prefix(1);
    }
    return take();
  }
  void skip_line() { rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size())); }
  [[nodiscard]] std::size_t line() const { return line_; }

 private:
  static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
  }
  std::string_view take() {
    std::size_t size = 0;
    while (size < rest_.size() && !is_blank(rest_[size])) ++size;
    const std::string_view word = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return word;
  }

  std::string_view rest_;
  std::size_t line_ = 1;
};

/// A finite number; nothing if the word is none.
std::optional<double> number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return {};
  return value;
}

Result<TriangleMesh> read_stl_words(std::string_view text) {
  MeshBuilder builder;
  Words words(text);
  std::array<Vector3, 3> corners;
  std::size_t corner = 0;
  std::size_t count = 0;
  words.skip_line();  // "solid" and a name of any words
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word == "endsolid" || word == "solid") words.skip_line();
    if (word == "facet") corner = 0;
    if (word != "vertex") continue;
    if (corner == 3) {
      return mesh_error(fmt::format("line {}: a facet with more than 3 vertices", words.line()));
    }
    for (int k = 0; k < 3; ++k) {
      const std::optional<double> value = number_of(words.next_in_line());
      if (!value) {
        return mesh_error(fmt::format("line {}: vertex must have 3 finite numbers", words.line()));
      }
      corners[corner][k] = *value;
    }
    if (++corner < 3) continue;
    if (++count > most_triangles) {
      return mesh_error(fmt::format("more than {} triangles", most_triangles));
    }
    builder.add(corners);
  }
  return std::move(builder.mesh);
}

/// Reads an OBJ file.
class ObjReader {
 public:
  explicit ObjReader(std::string_view text) : words_(text) {}

  Result<TriangleMesh> read() {
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      std::string fault;
      if (word == "v") fault = read_point();
      if (word == "f") fault = read_face();
      if (!fault.empty()) {
        return mesh_error(fmt::format("line {}: {}", words_.line(), fault));
      }
      words_.skip_line();  // colours of points, and lines of other kinds
    }
    return std::move(builder_.mesh);
  }

 private:
  std::string read_point() {
    Vector3 point;
    for (int k = 0; k < 3; ++k) {
      const std::optional<double> value = number_of(words_.next_in_line());
      if (!value) return "v must have 3 finite numbers";
      point[k] = *value;
    }
    if (points_.size() == 3 * most_triangles) return "too many points";
    points_.push_back(builder_.index(point));
    return {};
  }

  std::string read_face() {
    std::array<std::uint32_t, 3> corners{};
    std::size_t count = 0;
    for (auto word = words_.next_in_line(); !word.empty(); word = words_.next_in_line()) {
      // "point/texture/normal"; below 0 it counts from the last point.
      const std::optional<double> given = number_of(word.substr(0, word.find('/')));
      const auto size = static_cast<double>(points_.size());
      const double place = !given ? 0.0 : *given < 0.0 ? size + *given + 1.0 : *given;
      if (!(place >= 1.0 && place <= size) || place != std::floor(place)) {
        return fmt::format("f names the point \"{}\", and there are {} points before it", word,
                           points_.size());
      }
      corners[std::min<std::size_t>(count, 2)] = points_[static_cast<std::size_t>(place) - 1];
      if (++count < 3) continue;
      if (++triangles_ > most_triangles)
        return fmt::format("more than {} triangles", most_triangles);
      builder_.add(corners);
      corners[1] = corners[2];
    }
    return count < 3 ? "f must have 3 points or more" : "";
  }

  Words words_;
  MeshBuilder builder_;
  std::vector<std::uint32_t> points_;  // of each v, its place in the mesh
  std::size_t triangles_ = 0;
};

/// Whether each edge is passed once in each direction.
bool is_closed(const TriangleMesh& mesh) {
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * mesh.triangles.size());
  const auto key = [](std::uint32_t from, std::uint32_t to) {
    return (static_cast<std::uint64_t>(from) << 32U) | to;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    edges.insert(edges.end(), {key(a, b), key(b, c), key(c, a)});
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const std::uint64_t back = (edges[i] << 32U) | (edges[i] >> 32U);
    const auto [first, last] = std::equal_range(edges.begin(), edges.end(), back);
    const auto [own, end] = std::equal_range(edges.begin(), edges.end(), edges[i]);
    if (last - first != end - own) return false;
  }
  return true;
}

}  // namespace

Result<TriangleMesh> read_stl(std::string_view bytes) {
  // Binary files may begin with "solid", too; their size is that of their triangles.
  if (bytes.size() >= stl_head &&
      bytes.size() == stl_head + stl_triangle * std::size_t{word_at(bytes, stl_head - 4)}) {
    return read_binary_stl(bytes);
  }
  if (bytes.starts_with("solid")) return read_stl_words(bytes);
  return mesh_error(
      "no STL file: it begins with no \"solid\", and its size is not that of the triangles that a "
      "binary file has");
}

Result<TriangleMesh> read_obj(std::string_view text) { return ObjReader(text).read(); }

// Tetrahedra of each triangle and one point of the mesh, near which rounding is least:
// with the corners a, b, c seen from there, 6 V = a . (b x c), the centre is (a + b + c) / 4, and the
// second moments are V / 20 (a a^T + b b^T + c c^T + s s^T) with s = a + b + c.
Result<MeshSolid> solid_of(const TriangleMesh& mesh) {
  if (mesh.triangles.size() < 4) return mesh_error("it has no solid: fewer than 4 triangles");
  if (!is_closed(mesh)) {
    return mesh_error("its surface is not closed: an edge has no triangle on its other side");
  }
  const Vector3 origin = mesh.points[mesh.triangles.front()[0]];
  double volume = 0.0;
  Vector3 first = Vector3::Zero();
  Matrix3 second = Matrix3::Zero();
  for (const auto& triangle : mesh.triangles) {
    const Vector3 a = mesh.points[triangle[0]] - origin;
    const Vector3 b = mesh.points[triangle[1]] - origin;
    const Vector3 c = mesh.points[triangle[2]] - origin;
    const Vector3 s = a + b + c;
    const double part = a.dot(b.cross(c)) / 6.0;
    volume += part;
    first += 0.25 * part * s;
    second += part / 20.0 *
              (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  if (!(volume > 0.0) || !std::isfinite(volume)) {
    return mesh_error(
        "its volume is not above 0: its triangles must be counter-clockwise as seen "
        "from outside");
  }
  MeshSolid solid;
  solid.volume = volume;
  const Vector3 center = first / volume;
  solid.center = origin + center;
  second -= volume * center * center.transpose();
  solid.inertia = second.trace() * Matrix3::Identity() - second;
  return solid;
}

}  // namespace sheave::import

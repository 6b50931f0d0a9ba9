#include "view/gltf_builder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>
#include <utility>

#include <tiny_gltf.h>

namespace sheave::view {
namespace {

using LinearColor = std::array<double, 3>;

/// glTF uses linear colours.
double linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }
LinearColor linear(const render::Color& c) {
  return {linear(static_cast<double>(c.r)), linear(static_cast<double>(c.g)),
          linear(static_cast<double>(c.b))};
}

int components(int type) {
  return tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type));
}

}  // namespace

struct GltfBuilder::Content {
  tinygltf::Model model;
  std::vector<unsigned char> bytes;   // of meshes
  std::vector<unsigned char> motion;  // of animation
  std::map<std::array<float, 3>, int> materials;
  int times = -1;
  std::size_t moments = 0;

  Content() {
    model.asset.version = "2.0";
    model.asset.generator = "sheave";
    model.scenes.emplace_back();
    model.defaultScene = 0;
  }

  int view(const void* data, std::size_t size, int target) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = bytes.size();
    view.byteLength = size;
    view.target = target;
    const auto* first = static_cast<const unsigned char*>(data);
    bytes.insert(bytes.end(), first, first + size);
    model.bufferViews.push_back(std::move(view));
    return static_cast<int>(model.bufferViews.size()) - 1;
  }

  int accessor(int view, std::size_t offset, int component, int type, std::size_t count) {
    tinygltf::Accessor made;
    made.bufferView = view;
    made.byteOffset = offset;
    made.componentType = component;
    made.type = type;
    made.count = count;
    model.accessors.push_back(std::move(made));
    return static_cast<int>(model.accessors.size()) - 1;
  }

  static void add_range(tinygltf::Accessor& accessor, const std::vector<float>& values) {
    const auto n = static_cast<std::size_t>(components(accessor.type));
    for (std::size_t i = 0; i < n; ++i) {
      float least = values[i];
      float most = values[i];
      for (std::size_t k = i; k < values.size(); k += n) {
        least = std::min(least, values[k]);
        most = std::max(most, values[k]);
      }
      accessor.minValues.push_back(static_cast<double>(least));
      accessor.maxValues.push_back(static_cast<double>(most));
    }
  }

  /// Appends data of a mesh.
  int corners(const std::vector<float>& values, int type, bool range) {
    const int place =
        view(values.data(), values.size() * sizeof(float), TINYGLTF_TARGET_ARRAY_BUFFER);
    const auto n = static_cast<std::size_t>(components(type));
    const int made = accessor(place, 0, TINYGLTF_COMPONENT_TYPE_FLOAT, type, values.size() / n);
    if (range) add_range(model.accessors[static_cast<std::size_t>(made)], values);
    return made;
  }

  /// Appends data of an animation. Its bytes are collected separately and follow the meshes in a
  /// view of their own.
  int moving(const std::vector<double>& values, int type, bool range) {
    std::vector<float> numbers(values.begin(), values.end());
    const std::size_t offset = motion.size();
    motion.resize(offset + numbers.size() * sizeof(float));
    std::memcpy(motion.data() + offset, numbers.data(), numbers.size() * sizeof(float));
    const auto n = static_cast<std::size_t>(components(type));
    const int made = accessor(-1, offset, TINYGLTF_COMPONENT_TYPE_FLOAT, type, numbers.size() / n);
    if (range) add_range(model.accessors[static_cast<std::size_t>(made)], numbers);
    return made;
  }

  tinygltf::Primitive primitive(const render::Mesh& mesh) {
    std::vector<float> positions;
    std::vector<float> normals;
    for (const render::MeshVertex& vertex : mesh.vertices) {
      positions.insert(positions.end(), vertex.position.begin(), vertex.position.end());
      normals.insert(normals.end(), vertex.normal.begin(), vertex.normal.end());
    }
    tinygltf::Primitive made;
    made.mode = TINYGLTF_MODE_TRIANGLES;
    made.attributes["POSITION"] = corners(positions, TINYGLTF_TYPE_VEC3, true);
    made.attributes["NORMAL"] = corners(normals, TINYGLTF_TYPE_VEC3, false);
    const int place = view(mesh.triangles.data(), mesh.triangles.size() * sizeof(std::uint32_t),
                           TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    made.indices = accessor(place, 0, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                            mesh.triangles.size());
    return made;
  }

  int add_mesh(const std::string& name, tinygltf::Primitive primitive) {
    tinygltf::Mesh made;
    made.name = name;
    made.primitives.push_back(std::move(primitive));
    model.meshes.push_back(std::move(made));
    return static_cast<int>(model.meshes.size()) - 1;
  }
};

GltfBuilder::GltfBuilder() : content_(std::make_unique<Content>()) {}
GltfBuilder::~GltfBuilder() = default;

int GltfBuilder::material(const render::Color& color) {
  auto& model = content_->model;
  const auto [place, is_new] = content_->materials.emplace(
      std::array<float, 3>{color.r, color.g, color.b}, static_cast<int>(model.materials.size()));
  if (!is_new) return place->second;
  const LinearColor c = linear(color);
  tinygltf::Material made;
  made.pbrMetallicRoughness.baseColorFactor = {c[0], c[1], c[2], 1.0};
  made.pbrMetallicRoughness.metallicFactor = 0.0;
  made.pbrMetallicRoughness.roughnessFactor = 0.7;
  model.materials.push_back(std::move(made));
  return place->second;
}

int GltfBuilder::mesh(const std::string& name, const render::Mesh& mesh, int material,
                      const render::Color& accent) {
  if (mesh.triangles.empty()) return -1;
  tinygltf::Primitive primitive = content_->primitive(mesh);
  primitive.material = material;
  const bool painted = std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                                   [](const auto& v) { return v.paint != render::plain_paint; });
  if (painted) {
    // glTF multiplies the vertex colour by the material's colour. The factor of an accent is
    // therefore the quotient of both, limited to 1.
    const auto& base = content_->model.materials[static_cast<std::size_t>(material)]
                           .pbrMetallicRoughness.baseColorFactor;
    const LinearColor wanted = linear(accent);
    std::vector<float> colors;
    for (const render::MeshVertex& vertex : mesh.vertices) {
      for (std::size_t i = 0; i < 3; ++i) {
        double c = linear(vertex.paint[i] / 255.0);
        if (vertex.paint[3] > 0) c = std::min(1.0, wanted[i] / std::max(base[i], 1e-6));
        colors.push_back(static_cast<float>(c));
      }
    }
    primitive.attributes["COLOR_0"] = content_->corners(colors, TINYGLTF_TYPE_VEC3, false);
  }
  return content_->add_mesh(name, std::move(primitive));
}

int GltfBuilder::blended_mesh(const std::string& name, const render::Mesh& mesh,
                              const render::Color& base, const std::vector<render::Color>& blends) {
  tinygltf::Primitive primitive = content_->primitive(mesh);
  primitive.material = material(render::Color{1.0F, 1.0F, 1.0F});
  const auto everywhere = [&](const LinearColor& c) {
    std::vector<float> colors;
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
      for (const double part : c) colors.push_back(static_cast<float>(part));
    }
    return content_->corners(colors, TINYGLTF_TYPE_VEC3, false);
  };
  const LinearColor from = linear(base);
  primitive.attributes["COLOR_0"] = everywhere(from);
  // Blender does not blend colours, and it opens only morph targets with positions; their
  // displacements are 0.
  const int still =
      content_->corners(std::vector<float>(3 * mesh.vertices.size()), TINYGLTF_TYPE_VEC3, true);
  for (const render::Color& blend : blends) {
    const LinearColor to = linear(blend);
    primitive.targets.push_back(
        {{"POSITION", still},
         {"COLOR_0", everywhere({to[0] - from[0], to[1] - from[1], to[2] - from[2]})}});
  }
  const int made = content_->add_mesh(name, std::move(primitive));
  content_->model.meshes.back().weights.assign(blends.size(), 0.0);
  return made;
}

int GltfBuilder::node(const std::string& name, int parent, int mesh, const NodePlace& place) {
  auto& model = content_->model;
  tinygltf::Node made;
  made.name = name;
  made.mesh = mesh;
  const Vector3& t = place.translation;
  const Vector3& s = place.scale;
  if (t != Vector3::Zero()) made.translation = {t.x(), t.y(), t.z()};
  if (place.rotation.angularDistance(Quaternion::Identity()) > 0.0) {
    const Quaternion q = place.rotation.normalized();
    made.rotation = {q.x(), q.y(), q.z(), q.w()};
  }
  if (s != Vector3::Ones()) made.scale = {s.x(), s.y(), s.z()};
  const auto index = static_cast<int>(model.nodes.size());
  model.nodes.push_back(std::move(made));
  auto& siblings = parent < 0 ? model.scenes.front().nodes
                              : model.nodes[static_cast<std::size_t>(parent)].children;
  siblings.push_back(index);
  return index;
}

void GltfBuilder::set_weights(int node, const std::vector<double>& weights) {
  content_->model.nodes[static_cast<std::size_t>(node)].weights = weights;
}

void GltfBuilder::set_times(const std::vector<double>& times) {
  content_->moments = times.size();
  content_->times = content_->moving(times, TINYGLTF_TYPE_SCALAR, true);
  content_->model.animations.emplace_back();
  content_->model.animations.back().name = "run";
}

int GltfBuilder::track(NodePath path, const std::vector<double>& values, bool steps) {
  const int type = path == NodePath::rotation  ? TINYGLTF_TYPE_VEC4
                   : path == NodePath::weights ? TINYGLTF_TYPE_SCALAR
                                               : TINYGLTF_TYPE_VEC3;
  tinygltf::AnimationSampler sampler;
  sampler.input = content_->times;
  sampler.output = content_->moving(values, type, false);
  sampler.interpolation = steps ? "STEP" : "LINEAR";
  auto& samplers = content_->model.animations.back().samplers;
  samplers.push_back(std::move(sampler));
  return static_cast<int>(samplers.size()) - 1;
}

void GltfBuilder::animate(int node, NodePath path, int track) {
  constexpr std::array<const char*, 4> names{"translation", "rotation", "scale", "weights"};
  tinygltf::AnimationChannel channel;
  channel.sampler = track;
  channel.target_node = node;
  channel.target_path = names[static_cast<std::size_t>(path)];
  content_->model.animations.back().channels.push_back(std::move(channel));
}

std::string GltfBuilder::bytes() {
  tinygltf::Model& model = content_->model;
  // glTF does not allow an animation without channels.
  if (!model.animations.empty() && model.animations.back().channels.empty()) {
    model.animations.clear();
  }
  if (!content_->motion.empty()) {
    const int place = content_->view(content_->motion.data(), content_->motion.size(), 0);
    for (tinygltf::Accessor& accessor : model.accessors) {
      if (accessor.bufferView < 0) accessor.bufferView = place;
    }
  }
  model.buffers.resize(1);
  model.buffers.front().data = std::move(content_->bytes);
  std::ostringstream out;
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true);
  return out.str();
}

}  // namespace sheave::view

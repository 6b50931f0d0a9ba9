// Frames that are fixed to bodies, and sockets, which name them by a path.

#include <fmt/format.h>

#include "scenes/import/opensim/reader.h"

namespace sheave::import::opensim {
namespace {

constexpr int most_nested = 50;  // offset frames on offset frames

std::string last_part(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

/// The text of a socket, under its names in the versions of the format.
std::string socket_text(const xml::Element& object, std::string_view socket,
                        Properties& properties) {
  for (const char* const form :
       {"socket_{}", "socket_{}_connectee_name", "connector_{}_connectee_name"}) {
    std::string path = properties.text(object, fmt::format(fmt::runtime(form), socket));
    if (!path.empty()) return path;
  }
  return {};
}

/// Follows a path to a body through offset frames.
class FrameFinder {
 public:
  explicit FrameFinder(Reader& reader) : reader_(reader) {}

  FixedFrame find(const std::string& path, const std::string& inside, int depth) {
    if (depth > most_nested) {
      fault_ = fmt::format("more than {} frames on each other, or frames in a loop", most_nested);
      return {};
    }
    const std::string name = last_part(path);
    for (const std::string& key : {path, inside + "/" + name}) {
      const auto found = reader_.frames.find(key);
      if (found != reader_.frames.end()) return offset(found->first, *found->second, depth);
    }
    if (name == "ground") return {0, {}};
    const auto body = reader_.body_names.find(name);
    if (body != reader_.body_names.end()) return {body->second, {}};
    if (path == "..") return find(inside, "", depth + 1);
    // A path that counts from the object.
    const auto other = reader_.frame_names.find(name);
    if (other != reader_.frame_names.end()) {
      return offset(other->second, *reader_.frames.find(other->second)->second, depth);
    }
    fault_ = fmt::format("there is no frame or body \"{}\"", path.substr(0, 100));
    return {};
  }

  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  FixedFrame offset(const std::string& key, const xml::Element& element, int depth) {
    const std::string parent = socket_text(element, "parent", reader_.properties);
    const FixedFrame outer = find(parent, key.substr(0, key.rfind('/')), depth + 1);
    if (outer.body < 0) return {};
    reader_.properties.mark(element);
    mjcf::Frame own;
    own.position = reader_.properties.vector(element, "translation").value_or(Vector3::Zero());
    own.orientation =
        from_xyz(reader_.properties.vector(element, "orientation").value_or(Vector3::Zero()));
    reader_.log.same(element, "a frame");
    return {outer.body, outer.frame * own};
  }

  Reader& reader_;
  std::string fault_;
};

/// Enters the offset frames in these children, and in those of the frames.
void enter_frames(const xml::Element& parts, const std::string& path, int depth, Reader& reader) {
  if (depth > most_nested) return;
  for (const xml::Element& part : parts.children) {
    const std::string* const name = part.value("name");
    if (part.tag == "PhysicalOffsetFrame" && name != nullptr) {
      const std::string own = path + "/" + *name;
      reader.frames.emplace(own, &part);
      reader.frame_names.emplace(*name, own);
      enter_frames(part, own, depth + 1, reader);
    } else if (part.tag == "components" || part.tag == "frames") {
      reader.properties.mark(part);
      enter_frames(part, path, depth + 1, reader);
    }
  }
}

void enter_set(std::string_view tag, const std::string& path, Reader& reader) {
  for (const xml::Element* const object : reader.properties.objects(reader.root, tag)) {
    const std::string* const name = object->value("name");
    if (name != nullptr) enter_frames(*object, path + "/" + *name, 0, reader);
  }
}

}  // namespace

Quaternion from_xyz(const Vector3& angles) {
  return mjcf::turn_about(Vector3::UnitX(), angles.x()) *
         mjcf::turn_about(Vector3::UnitY(), angles.y()) *
         mjcf::turn_about(Vector3::UnitZ(), angles.z());
}

void find_frames(Reader& reader) {
  enter_set("BodySet", "/bodyset", reader);
  enter_set("JointSet", "/jointset", reader);
  enter_set("ConstraintSet", "/constraintset", reader);
  for (const xml::Element& child : reader.root.children) {
    if (child.tag == "Ground") enter_frames(child, "/ground", 0, reader);
    if (child.tag == "ComponentSet" || child.tag == "components") {
      enter_frames(child, "", 0, reader);
      for (const xml::Element& objects : child.children) enter_frames(objects, "", 0, reader);
    }
  }
}

FixedFrame frame_of(const xml::Element& object, std::string_view socket, const std::string& inside,
                    Reader& reader) {
  const std::string path = socket_text(object, socket, reader.properties);
  if (path.empty()) {
    reader.log.error(object, fmt::format("<socket_{}> is missing: the path of a frame", socket), {},
                     FaultCode::missing_key);
    return {};
  }
  FrameFinder finder(reader);
  const FixedFrame found = finder.find(path, inside, 0);
  if (found.body < 0) reader.log.error(object, finder.fault(), path, FaultCode::meaning);
  return found;
}

}  // namespace sheave::import::opensim

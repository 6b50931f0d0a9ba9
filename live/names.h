#pragma once
// Bodies, joints and cables by their names in requests.

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "cable/live_world.h"

namespace sheave::live {

/// Index of the names of a world. A fault has the pointer `pointer` and suggests a similar name.
class Names {
 public:
  /// `world` must outlive this object.
  explicit Names(const LiveWorld& world);
  /// Reads the names of the world again.
  void refresh();
  Names(const Names&) = delete;
  Names& operator=(const Names&) = delete;

  /// Names of all bodies, in the order of their handles.
  [[nodiscard]] const std::vector<std::string>& bodies() const { return bodies_.names; }
  /// Number of slots of body handles.
  [[nodiscard]] int body_slots() const { return body_slots_; }
  [[nodiscard]] Result<BodyHandle> body(const std::string& name,
                                        const std::string& pointer = "/body") const;
  [[nodiscard]] Result<JointHandle> joint(const std::string& name,
                                          const std::string& pointer = "/joint") const;
  [[nodiscard]] Result<CableHandle> cable(const std::string& name,
                                          const std::string& pointer = "/cable") const;
  /// Index of a coordinate of a joint; an empty name is the first.
  [[nodiscard]] Result<int> coordinate(JointHandle joint, const std::string& name) const;

 private:
  /// The names of one kind of objects in their order, with their handles.
  template <class Handle>
  struct Index {
    std::vector<std::string> names;
    std::unordered_map<std::string, Handle> handles;
    void add(std::string name, Handle handle) {
      handles.emplace(name, handle);
      names.push_back(std::move(name));
    }
    [[nodiscard]] Result<Handle> find(const char* what, const std::string& name,
                                      const std::string& pointer) const;
  };

  const LiveWorld& world_;
  int body_slots_ = 0;
  Index<BodyHandle> bodies_;
  Index<JointHandle> joints_;
  Index<CableHandle> cables_;
};

/// The fault of an unknown name: there is no body "drun", did you mean "drum"?
[[nodiscard]] Error no_such(const std::string& what, const std::string& name,
                            const std::vector<std::string_view>& names, const std::string& pointer);

}  // namespace sheave::live

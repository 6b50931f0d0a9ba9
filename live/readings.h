#pragma once
// Values that are read repeatedly from a world: quantities and poses.

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "cable/live_world.h"
#include "live/names.h"
#include "live/request.h"
#include "scenes/observables.h"

namespace sheave::live {

/// Index of the quantities of a world by name.
class QuantityIndex {
 public:
  explicit QuantityIndex(const Simulation& simulation);
  QuantityIndex(const QuantityIndex&) = delete;
  QuantityIndex& operator=(const QuantityIndex&) = delete;
  [[nodiscard]] const ObservableSet& set() const { return set_; }
  /// Index in set().names(); the error suggests a name.
  [[nodiscard]] Result<int> find(const std::string& name) const;

 private:
  ObservableSet set_;
  std::unordered_map<std::string_view, int> indices_;
};

/// The quantities and poses that a request names, by their indices.
class Readings {
 public:
  /// Faults have pointers into the lists "quantities" and "poses". Names must not occur twice.
  static Result<Readings> create(const QuantityIndex& index, const Names& names,
                                 const std::vector<std::string>& quantities,
                                 const std::vector<std::string>& poses);
  [[nodiscard]] bool empty() const { return indices_.empty() && bodies_.empty(); }
  /// Updates the indices for an edited world. Removed objects read as null from then on.
  void find_again(const QuantityIndex& index, const Names& names);
  /// Appends "values" and "poses", if there are any. Unknown values, such as forces before the
  /// first step, are null.
  void read(const QuantityIndex& index, const LiveWorld& world, Json& answer) const;

 private:
  std::vector<std::string> quantities_;
  std::vector<int> indices_;  // -1: removed
  std::vector<std::string> bodies_;
  std::vector<BodyHandle> handles_;
};

}  // namespace sheave::live

#pragma once
// What is read of a world again and again: quantities and poses.

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "cable/live_world.h"
#include "live/names.h"
#include "live/request.h"
#include "scenes/observables.h"

namespace sheave::live {

/// The quantities of a world, found by their names at once.
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

/// Quantities and poses, by their places. Those that a request names.
class Readings {
 public:
  /// Faults have pointers into the lists "quantities" and "poses". Names must not be given twice.
  static Result<Readings> create(const QuantityIndex& index, const Names& names,
                                 const std::vector<std::string>& quantities,
                                 const std::vector<std::string>& poses);
  [[nodiscard]] bool empty() const { return indices_.empty() && bodies_.empty(); }
  /// The same of a world that has been edited: what is no more is null from now on.
  void find_again(const QuantityIndex& index, const Names& names);
  /// Appends "values" and "poses", as far as there are any. What is not known, as forces before the
  /// first step, is null.
  void read(const QuantityIndex& index, const LiveWorld& world, Json& answer) const;

 private:
  std::vector<std::string> quantities_;
  std::vector<int> indices_;  // -1: is no more
  std::vector<std::string> bodies_;
  std::vector<BodyHandle> handles_;
};

}  // namespace sheave::live

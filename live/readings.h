#pragma once
// Values that are read repeatedly from a world: quantities and poses.

#include <memory>
#include <string>
#include <vector>

#include "cable/live_world.h"
#include "live/names.h"
#include "live/request.h"
#include "scenes/quantity_list.h"

namespace sheave::live {

using QuantityIndexPointer = std::shared_ptr<const QuantityIndex>;

/// The quantities, expressions and poses that a request names.
class Readings {
 public:
  /// Faults have pointers into the lists "quantities" and "poses". Names must not occur twice.
  static Result<Readings> create(const QuantityIndexPointer& index, const Names& names,
                                 const std::vector<std::string>& quantities,
                                 const std::vector<std::string>& poses);
  [[nodiscard]] bool empty() const { return quantities_.empty() && bodies_.empty(); }
  /// Looks everything up again, in an edited world. Removed objects read as null from then on.
  void find_again(const QuantityIndexPointer& index, const Names& names);
  /// Appends "values" and "poses", if there are any. Unknown values, such as forces before the
  /// first step, are null.
  void read(const LiveWorld& world, Json& answer) const;

 private:
  explicit Readings(const QuantityIndexPointer& index) : list_(index) {}

  std::vector<std::string> quantities_;
  std::vector<int> places_;  // of the quantities in list_; -1: removed
  QuantityList list_;
  std::vector<std::string> bodies_;
  std::vector<BodyHandle> handles_;
};

}  // namespace sheave::live

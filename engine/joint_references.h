#pragma once

#include <string>

#include "engine/result.h"

namespace sheave {

class BodySet;
struct Model;

/// A part of the definition of a joint that names other joints of the model.
class JointReferences {
 public:
  virtual ~JointReferences() = default;
  /// Errors of the names, with paths below `path`. The other joints of `model` may be null or
  /// invalid themselves.
  [[nodiscard]] virtual Errors check_references(const Model& model, const BodySet& bodies,
                                                const std::string& path) const = 0;

 protected:
  JointReferences() = default;
  JointReferences(const JointReferences&) = default;
  JointReferences& operator=(const JointReferences&) = default;
};

}  // namespace sheave

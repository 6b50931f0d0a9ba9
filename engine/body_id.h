#pragma once

namespace sheave {

/// A body of a model: its index in Model::bodies, or the immovable world.
struct BodyId {
  int index = world_index;  ///< -1: the world

  static constexpr int world_index = -1;
  /// The world: a static body at the origin that every model has. Scenes call it "world".
  [[nodiscard]] static constexpr BodyId world() { return {}; }
  [[nodiscard]] constexpr bool is_world() const { return index == world_index; }
  friend constexpr bool operator==(BodyId, BodyId) = default;
};

}  // namespace sheave

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sheave {

/// Finds the candidate that a user probably meant by an unknown word: the nearest by the number of
/// inserted, deleted, replaced and swapped letters, ignoring case.
class Suggestion {
 public:
  explicit Suggestion(std::string_view text);
  /// Of equally near candidates the first wins. `candidate` must outlive the suggestion.
  void consider(std::string_view candidate);
  /// The best candidate so far; empty if none is near enough.
  [[nodiscard]] std::string_view best() const { return best_; }
  /// ", did you mean \"...\"?", or nothing.
  [[nodiscard]] std::string question() const;

 private:
  [[nodiscard]] std::size_t distance(std::string_view candidate);

  std::string text_;  // lower case
  std::string_view best_;
  std::size_t best_distance_;  // candidates must be nearer than this
  std::vector<std::size_t> before_previous_, previous_, current_;  // rows of the distance table
};

/// The candidates that are near enough to `word`, the nearest first, at most `most`.
[[nodiscard]] std::vector<std::string_view> nearest(std::string_view word,
                                                    std::vector<std::string_view> candidates,
                                                    std::size_t most);

}  // namespace sheave

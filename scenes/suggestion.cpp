#include "scenes/suggestion.h"

#include <algorithm>

namespace sheave {
namespace {

// Longer words are not mistyped names; comparing them only takes time.
constexpr std::size_t max_length = 64;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

Suggestion::Suggestion(std::string_view text)
    : text_(text), best_distance_(std::min<std::size_t>(text.size() / 3, 3) + 2) {
  for (char& c : text_) c = lower(c);
}

void Suggestion::consider(std::string_view candidate) {
  if (text_.empty() || text_.size() > max_length || candidate.size() > max_length) return;
  const std::size_t longer = std::max(text_.size(), candidate.size());
  const std::size_t shorter = std::min(text_.size(), candidate.size());
  if (longer - shorter >= best_distance_) return;  // the distance is at least this
  const std::size_t d = distance(candidate);
  // Words without a common letter are never near, even if they are short.
  if (d >= best_distance_ || d >= longer) return;
  best_distance_ = d;
  best_ = candidate;
}

std::string Suggestion::question() const {
  return best_.empty() ? std::string() : ", did you mean \"" + std::string(best_) + "\"?";
}

// Optimal string alignment: Levenshtein's table, row by row, plus swaps of neighbouring letters.
std::size_t Suggestion::distance(std::string_view candidate) {
  const std::size_t n = candidate.size();
  before_previous_.assign(n + 1, 0);
  current_.assign(n + 1, 0);
  previous_.resize(n + 1);
  for (std::size_t j = 0; j <= n; ++j) previous_[j] = j;
  for (std::size_t i = 1; i <= text_.size(); ++i) {
    current_[0] = i;
    for (std::size_t j = 1; j <= n; ++j) {
      const std::size_t cost = text_[i - 1] == lower(candidate[j - 1]) ? 0 : 1;
      current_[j] = std::min({previous_[j] + 1, current_[j - 1] + 1, previous_[j - 1] + cost});
      const bool swapped = i > 1 && j > 1 && text_[i - 1] == lower(candidate[j - 2]) &&
                           text_[i - 2] == lower(candidate[j - 1]);
      if (swapped) current_[j] = std::min(current_[j], before_previous_[j - 2] + 1);
    }
    before_previous_.swap(previous_);
    previous_.swap(current_);
  }
  return previous_[n];
}

std::vector<std::string_view> nearest(std::string_view word,
                                      std::vector<std::string_view> candidates, std::size_t most) {
  std::vector<std::string_view> result;
  while (result.size() < most) {
    Suggestion suggestion(word);
    for (const std::string_view candidate : candidates) suggestion.consider(candidate);
    if (suggestion.best().empty()) break;
    result.push_back(suggestion.best());
    std::erase(candidates, suggestion.best());
  }
  return result;
}

}  // namespace sheave

#pragma once
// Collects the worst figure of each kind. Names are composed only for the worst, since that is
// expensive.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "cable/certificate.h"

namespace sheave::certify {

class Findings {
 public:
  using Kind = CertificateItem::Kind;

  explicit Findings(double time) : time_(time) {}

  /// `value` is the error, `scale` its reference; errors up to `rounding` count as 0. `name()` is
  /// called only if this is the worst so far.
  template <class Name>
  void note(Kind kind, std::string_view unit, double value, double scale, double rounding,
            const Name& name) {
    std::optional<CertificateItem>& worst = worst_[static_cast<std::size_t>(kind)];
    const double excess = std::max(value - rounding, 0.0);
    double relative = scale > 0.0 ? excess / scale : (excess > 0.0 ? unbounded : 0.0);
    if (!std::isfinite(relative)) relative = unbounded;
    if (worst && !(relative > worst->relative)) return;
    const double off = std::max(value, 0.0) + 0.0;  // + 0.0 turns a negative zero into zero
    worst = CertificateItem{kind, name(), off, unit, scale, relative, time_, {}};
  }

  /// In the order of the kinds.
  [[nodiscard]] std::vector<CertificateItem> take() {
    std::vector<CertificateItem> items;
    for (std::optional<CertificateItem>& item : worst_) {
      if (item) items.push_back(std::move(*item));
    }
    return items;
  }

 private:
  static constexpr double unbounded = 1e300;
  double time_;
  std::array<std::optional<CertificateItem>, certificate_kinds> worst_;
};

}  // namespace sheave::certify

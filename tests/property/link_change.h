#pragma once

#include <memory>
#include <stdexcept>
#include <type_traits>

#include "cable/links/attachment.h"
#include "cable/links/hybrid.h"
#include "cable/links/pinhole.h"
#include "cable/links/rolling.h"
#include "cable/links/spool.h"

namespace sheave::test {

/// A copy of a link, changed by `point` (attachments and pinholes) or `wheel` (all others).
template <class Point, class Wheel>
std::shared_ptr<const LinkDef> changed(const LinkDef& link, Point point, Wheel wheel) {
  const auto copy = [&](const auto* original, auto change) {
    auto result = std::make_shared<std::remove_cvref_t<decltype(*original)>>(*original);
    change(*result);
    return std::shared_ptr<const LinkDef>(result);
  };
  if (const auto* a = dynamic_cast<const AttachmentLink*>(&link)) return copy(a, point);
  if (const auto* p = dynamic_cast<const PinholeLink*>(&link)) return copy(p, point);
  if (const auto* r = dynamic_cast<const RollingLink*>(&link)) return copy(r, wheel);
  if (const auto* h = dynamic_cast<const HybridLink*>(&link)) return copy(h, wheel);
  if (const auto* s = dynamic_cast<const SpoolLink*>(&link)) return copy(s, wheel);
  throw std::logic_error("no such link type");
}

}  // namespace sheave::test

#include "command/run/checker.h"

#include <initializer_list>

#include <fmt/format.h>

namespace sheave::command {
namespace {

using Kind = CertificateItem::Kind;

/// The item of these kinds with the largest relative value; null if no such item was checked.
const CertificateItem* worst_of(const Certificate& certificate, std::initializer_list<Kind> kinds) {
  const CertificateItem* worst = nullptr;
  for (const Kind kind : kinds) {
    const CertificateItem* item = certificate.find(kind);
    if (item != nullptr && (worst == nullptr || item->relative > worst->relative)) worst = item;
  }
  return worst;
}

/// Adding 0.0 turns -0 into 0.
std::string certificate_share(double relative) { return fmt::format("{:.1g}", relative + 0.0); }

}  // namespace

std::string doubt_text(const Certificate& certificate, double trust) {
  const CertificateItem* worst = certificate.worst();
  if (worst == nullptr) return "";
  std::string text = worst->sentence();
  std::string others;
  for (const CertificateItem& item : certificate.items) {
    if (&item == worst || item.relative <= trust) continue;
    others += fmt::format("{}{} ({}, {:.2g} %)", others.empty() ? "" : ", ",
                          certificate_kind_names[static_cast<std::size_t>(item.kind)], item.name,
                          100.0 * item.relative);
  }
  return others.empty() ? text : text + "; also doubtful: " + others;
}

std::string certificate_text(const Certificate& certificate, double trust) {
  if (certificate.substeps == 0) return "checked: nothing";
  if (!certificate.clean(trust)) return "doubtful: " + doubt_text(certificate, trust);
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (const auto* item =
          worst_of(certificate, {Kind::joint, Kind::span, Kind::drive, Kind::contact})) {
    add(fmt::format("constraints within {:.1g} {}", item->value, item->unit));
  }
  if (const auto* item = worst_of(certificate, {Kind::momentum, Kind::angular_momentum})) {
    add("forces balance within " + certificate_share(item->relative) + " of the largest");
  }
  if (const auto* item = worst_of(certificate, {Kind::complementarity, Kind::force_law})) {
    add("laws of forces within " + certificate_share(item->relative));
  }
  if (const auto* item = certificate.find(Kind::friction)) {
    add("friction within " + certificate_share(item->relative) + " of its bounds");
  }
  if (const auto* item = certificate.find(Kind::energy)) {
    add("energy within " + certificate_share(item->relative) + " of the energy flow");
  }
  if (const auto* item = certificate.find(Kind::length)) {
    add("cable lengths within " + certificate_share(item->relative));
  }
  return fmt::format("checked: {}, in {} substeps", text, certificate.substeps);
}

}  // namespace sheave::command

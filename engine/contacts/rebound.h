#pragma once

#include <span>
#include <vector>

#include "engine/contacts/contact.h"

namespace sheave {

/// Velocities after impacts. Positions have already been moved apart, and velocities follow from
/// that; but what a bounce leaves is not what the way of a substep says.
class Rebound {
 public:
  /// Finds Contact::rebound of the contacts that meet in this substep, changes the velocities in
  /// substep.next, and adds h times the impulses to the multipliers, three per contact.
  void run(Substep& substep, std::span<Contact> contacts, std::span<double> multipliers);

 private:
  struct Impact {
    std::size_t contact = 0;
    double wanted = 0.0;  ///< normal velocity [m/s]
    std::vector<Row> rows;
    std::vector<RowResponse> responses;
  };

  void collect(const Substep& substep, std::span<const Contact> contacts,
               std::span<const double> multipliers);
  void find_rebounds(Substep& substep, std::span<Contact> contacts,
                     std::span<const double> multipliers);
  /// Friction of one contact, whose norm has this limit [kg m]; returns how far it has changed the
  /// velocities [m/s].
  static double rub(Substep& substep, const Impact& impact, double limit, double* multipliers);
  void sweep(Substep& substep, std::span<const Contact> contacts, std::span<double> multipliers);

  std::vector<Impact> impacts_;
  std::vector<BodyState> kept_;
};

}  // namespace sheave

#pragma once

#include <span>
#include <vector>

#include "engine/contacts/contact.h"
#include "engine/contacts/held_rows.h"

namespace sheave {

/// Velocities after impacts. The positions have been separated before, and the velocities derived
/// from them; a rebound velocity differs from the mean velocity of the substep.
class Rebound {
 public:
  /// Computes Contact::rebound of the contacts with an impact in this substep, changes the
  /// velocities in substep.next, and adds h times the impulses to the multipliers, three per
  /// contact. Rigid rows of the other `features` keep their velocities, and get their share.
  void run(Substep& substep, std::span<Contact> contacts, std::span<double> multipliers,
           std::span<const std::unique_ptr<ConstraintBatch>> features, const ConstraintBatch& own);
  /// Lets contacts pass (Contact::passes) only if rows of other features act on their bodies.
  void keep_passing(Substep& substep, std::span<Contact> contacts,
                    std::span<const std::unique_ptr<ConstraintBatch>> features,
                    const ConstraintBatch& own);
  /// Performs the impacts of the contacts that land at the end of the substep, by the velocities
  /// there. `slow` [s]: a landing contact rebounds if it is faster than its acceleration times
  /// `slow`. Adds h times the impulses to the multipliers, and the impulses to the late forces;
  /// `place` is the index of the contacts among the features.
  void land(Substep& substep, std::span<const Contact> contacts, std::span<double> multipliers,
            double slow, std::span<const std::unique_ptr<ConstraintBatch>> features,
            std::size_t place);

 private:
  struct Impact {
    std::size_t contact = 0;
    double wanted = 0.0;  ///< normal velocity to reach [m/s]
    std::vector<Row> rows;
    std::vector<RowResponse> responses;
  };

  void collect(const Substep& substep, std::span<const Contact> contacts,
               std::span<const double> multipliers);
  void add(const Substep& substep, std::span<const Contact> contacts, std::size_t contact);
  void find_rebounds(Substep& substep, std::span<Contact> contacts,
                     std::span<const double> multipliers);
  /// Solves friction of one contact, whose norm is limited by `limit` [kg m]; returns the change of
  /// velocity [m/s].
  static double rub(Substep& substep, const Impact& impact, double limit, double* multipliers);
  /// Velocities of bodies without any contact, whose joints and taut cables hold.
  void hold(Substep& substep);
  void sweep(Substep& substep, std::span<const Contact> contacts, std::span<double> multipliers);

  std::vector<Impact> impacts_;
  std::vector<BodyState> kept_;
  std::vector<double> impulses_;  // h times those of the instant, three per contact
  HeldRows held_;
};

}  // namespace sheave

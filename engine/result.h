#pragma once
// Errors are values: nothing in the library prints or exits, and no fault of an input is thrown.

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace sheave {

/// One fault in what the caller asked for.
struct Error {
  /// JSON pointer of the offending setting inside a scene, e.g. "/bodies/3/mass"; empty if the
  /// fault belongs to no single setting. Programs that build models in C++ read it as a path
  /// through the definition structs, which have the same names.
  std::string path;
  /// Names the thing and says what is wrong and what is allowed, as one sentence.
  std::string message;
};

/// All faults found, in the order in which the checks ran. Empty means none.
using Errors = std::vector<Error>;

namespace detail {
/// Throws a std::logic_error with the faults' messages: the value of a failure was read.
[[noreturn]] void reject_value(const Errors& faults);
}  // namespace detail

/// A value, or the faults that prevented it (at least one).
///
/// Two idioms, neither of which can fail unseen:
///
///   auto crane = load("crane.json");
///   if (!crane) return report(crane.errors());       // then *crane and crane-> are safe
///
///   Errors faults;                                   // many values, one question
///   const auto winch = crane->body("winch").value(faults);
///   const auto rope = crane->cable("rope").value(faults);
///   if (!faults.empty()) return report(faults);
///
/// Whoever reads the value of a failure without asking gets a std::logic_error that carries the
/// messages of its faults. That is a mistake in the program, and the only thing here that throws.
template <class T>
class Result {
 public:
  // Implicit, so that functions return a value or an error as it is.
  // NOLINTBEGIN(google-explicit-constructor)
  Result(T value) : content_(std::move(value)) {}
  Result(Error error) : content_(Errors{std::move(error)}) {}
  Result(Errors errors) : content_(std::move(errors)) {}
  // NOLINTEND(google-explicit-constructor)

  [[nodiscard]] bool ok() const { return std::holds_alternative<T>(content_); }
  explicit operator bool() const { return ok(); }

  /// The value; a failure adds its faults to `faults` and gives T{}. A handle that is made so
  /// names nothing, and every call that is given one answers with a fault.
  [[nodiscard]] T value(Errors& faults) const& {
    if (ok()) return *std::get_if<T>(&content_);
    faults.insert(faults.end(), errors().begin(), errors().end());
    return T{};
  }

  /// The value, for those who have asked ok().
  [[nodiscard]] T& value() & { return ok() ? *std::get_if<T>(&content_) : reject(); }
  [[nodiscard]] const T& value() const& { return ok() ? *std::get_if<T>(&content_) : reject(); }
  [[nodiscard]] T&& value() && { return std::move(value()); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }

  /// The faults; none if ok().
  [[nodiscard]] const Errors& errors() const {
    static const Errors none;
    const Errors* const faults = std::get_if<Errors>(&content_);
    return faults != nullptr ? *faults : none;
  }

 private:
  [[noreturn]] T& reject() const { detail::reject_value(errors()); }

  std::variant<T, Errors> content_;
};

}  // namespace sheave

#pragma once
// Errors are values: the library neither prints nor exits, and it never throws for invalid input.

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace sheave {

/// One error in the caller's input.
struct Error {
  /// JSON pointer to the offending setting inside a scene, e.g. "/bodies/3/mass"; empty if the
  /// error belongs to no single setting. Programs that build models in C++ read the pointer as a
  /// path through the definition structs, whose members have the same names.
  std::string path;
  /// One sentence that names the object, the fault and the allowed values.
  std::string message;
};

/// All errors found, in the order of the checks. Empty: the input is valid.
using Errors = std::vector<Error>;

namespace detail {
/// Throws a std::logic_error with the messages of `faults`: the program read the value of a
/// failure.
[[noreturn]] void reject_value(const Errors& faults);
}  // namespace detail

/// A value, or the errors that prevented it (at least one).
///
/// Two idioms, neither of which lets an error pass unseen:
///
///   auto crane = load("crane.json");
///   if (!crane) return report(crane.errors());       // then *crane and crane-> are safe
///
///   Errors faults;                                   // many values, one question
///   const auto winch = crane->body("winch").value(faults);
///   const auto rope = crane->cable("rope").value(faults);
///   if (!faults.empty()) return report(faults);
///
/// Reading the value of a failure without either idiom throws a std::logic_error with the messages.
/// This exception marks a mistake in the program, and nothing else in the library throws.
template <class T>
class Result {
 public:
  // The constructors are implicit, so that a function can return a value or an error directly.
  // NOLINTBEGIN(google-explicit-constructor)
  Result(T value) : content_(std::move(value)) {}
  Result(Error error) : content_(Errors{std::move(error)}) {}
  Result(Errors errors) : content_(std::move(errors)) {}
  // NOLINTEND(google-explicit-constructor)

  [[nodiscard]] bool ok() const { return std::holds_alternative<T>(content_); }
  explicit operator bool() const { return ok(); }

  /// The value; a failure appends its errors to `faults` and returns T{}. A handle T{} names
  /// nothing, and every call with such a handle returns an error.
  [[nodiscard]] T value(Errors& faults) const& {
    if (ok()) return *std::get_if<T>(&content_);
    faults.insert(faults.end(), errors().begin(), errors().end());
    return T{};
  }

  /// The value; call ok() first.
  [[nodiscard]] T& value() & { return ok() ? *std::get_if<T>(&content_) : reject(); }
  [[nodiscard]] const T& value() const& { return ok() ? *std::get_if<T>(&content_) : reject(); }
  [[nodiscard]] T&& value() && { return std::move(value()); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }

  /// The errors; empty if ok().
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

#pragma once
// Errors are values: nothing in the library throws, prints or exits.

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

/// A value, or the faults that prevented it (at least one).
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

  /// The value; valid only when ok().
  [[nodiscard]] T& value() & { return std::get<T>(content_); }
  [[nodiscard]] const T& value() const& { return std::get<T>(content_); }
  [[nodiscard]] T&& value() && { return std::get<T>(std::move(content_)); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }

  /// The faults; valid only when not ok().
  [[nodiscard]] const Errors& errors() const { return std::get<Errors>(content_); }

 private:
  std::variant<T, Errors> content_;
};

}  // namespace sheave

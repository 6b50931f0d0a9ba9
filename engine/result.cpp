#include "engine/result.h"

#include <stdexcept>

namespace sheave::detail {

void reject_value(const Errors& faults) {
  std::string message = "sheave::Result has no value";
  for (const Error& fault : faults) {
    message += "; ";
    if (!fault.path.empty()) message += fault.path + ": ";
    message += fault.message;
  }
  throw std::logic_error(message);
}

}  // namespace sheave::detail

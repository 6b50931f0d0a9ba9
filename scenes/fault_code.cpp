#include "scenes/fault_code.h"

#include <array>

namespace sheave {
namespace {

constexpr std::array<CodeEntry, 20> codes{{
    {"not-found", "error", "there is no such file"},
    {"unreadable", "error", "the file exists and cannot be read, or is a folder"},
    {"too-large", "error", "too many bytes, values, elements of a list, or levels of nesting"},
    {"encoding", "error", "the text is not UTF-8, or has a null character"},
    {"syntax", "error", "the text is not JSON"},
    {"number-range", "error", "a number that a double cannot hold"},
    {"duplicate-key", "error", "a key that the object has already"},
    {"unknown-key", "error", "a key that no such object has"},
    {"missing-key", "error", "a required key is not there"},
    {"exclusive-keys", "error", "two keys of which only one may be there"},
    {"wrong-type", "error", "a value of another type than allowed, e.g. a string for a number"},
    {"out-of-range", "error", "a number outside the range of its key"},
    {"unknown-choice", "error", "a word that is none of those allowed"},
    {"unknown-body", "error", "a name that no body has"},
    {"bad-name", "error", "a name with characters that are not allowed, or the name of the world"},
    {"duplicate-name", "error", "a name that another of its kind has"},
    {"bad-pointer", "error", "an override of a place that the scene does not have"},
    {"meaning", "error", "values that are allowed one by one, but not together"},
    {"magnitude", "warning", "a number outside the range of reliable results"},
    {"crossed-winding", "warning", "a winding whose sense is probably wrong"},
}};

}  // namespace

std::span<const CodeEntry> code_table() { return codes; }

std::string_view code_name(FaultCode code) { return codes[static_cast<std::size_t>(code)].code; }

}  // namespace sheave

#include "scenes/jsonnet/virtual_machine.h"

#if SHEAVE_HAS_JSONNET

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <system_error>
#include <variant>
#include <vector>

#include <jsonnet_library.h>

// The header does not declare its functions as C functions.
extern "C" {
#include <libjsonnet.h>
}

#include <nlohmann/json.hpp>

#include "scenes/csv.h"

namespace sheave::jsonnet {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view library_name = "sheave.libsonnet";

struct VmEnd {
  void operator()(JsonnetVm* vm) const { jsonnet_destroy(vm); }
};
using Vm = std::unique_ptr<JsonnetVm, VmEnd>;

/// Data of the import callback.
struct Importer {
  JsonnetVm* vm = nullptr;
  std::vector<fs::path> folders;  // real paths of the folders for imports; the program's first
  std::size_t most_bytes = 0;
  const std::function<void(const Source&)>* imported = nullptr;
  std::vector<Source> sources{};  // the imported files
};

char* vm_text(JsonnetVm* vm, std::string_view text) {
  char* const copy = jsonnet_realloc(vm, nullptr, text.size() + 1);
  std::memcpy(copy, text.data(), text.size());
  copy[text.size()] = '\0';
  return copy;
}

bool is_within(const fs::path& file, const fs::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end();
}

struct Found {
  std::string name;
  std::string text;
  std::string fault;
};

Found read_import(const Importer& importer, const std::string& base, const std::string& wanted) {
  std::vector<fs::path> candidates{fs::path(base) / wanted};
  for (const fs::path& folder : importer.folders) candidates.push_back(folder / wanted);
  for (const fs::path& candidate : candidates) {
    std::error_code code;
    const fs::path real = fs::canonical(candidate, code);
    if (code || fs::is_directory(real, code)) continue;
    const bool allowed =
        std::any_of(importer.folders.begin(), importer.folders.end(),
                    [&](const fs::path& folder) { return is_within(real, folder); });
    if (!allowed) {
      return {{}, {}, "is outside of the scene's folder; --import-from FOLDER allows another"};
    }
    if (fs::file_size(real, code) > importer.most_bytes || code) {
      return {{}, {}, "is no file, or too large"};
    }
    std::ifstream file(real, std::ios::binary);
    Found found{candidate.lexically_normal().string(), {}, {}};
    found.text.assign(std::istreambuf_iterator<char>(file), {});
    if (!file) return {{}, {}, "cannot be read"};
    return found;
  }
  if (wanted == library_name) return {std::string(library_name), std::string(library_text), {}};
  return {{}, {}, "there is no such file"};
}

char* import_file(void* context, const char* base, const char* wanted, char** found_here,
                  int* success) {
  auto& importer = *static_cast<Importer*>(context);
  const Found found = read_import(importer, base, wanted);
  *success = found.fault.empty() ? 1 : 0;
  if (!found.fault.empty()) return vm_text(importer.vm, found.fault);
  *found_here = vm_text(importer.vm, found.name);
  (*importer.imported)({found.name, found.text});
  importer.sources.push_back({found.name, found.text});
  return vm_text(importer.vm, found.text);
}

/// The native function csv(text) of the library: an object with one list of numbers per column.
JsonnetJsonValue* read_csv(void* context, const JsonnetJsonValue* const* arguments, int* success) {
  const auto& importer = *static_cast<const Importer*>(context);
  JsonnetVm* const vm = importer.vm;
  *success = 0;
  const char* const given = jsonnet_json_extract_string(vm, arguments[0]);
  if (given == nullptr) return jsonnet_json_make_string(vm, "csv: the table must be a text");
  const std::string text(given);
  const auto fail = [&](const CsvFault& fault) {
    const auto source = std::find_if(importer.sources.begin(), importer.sources.end(),
                                     [&](const Source& one) { return one.text == text; });
    const std::string file = source == importer.sources.end() ? "csv" : source->name;
    return jsonnet_json_make_string(vm, fault.text(file).c_str());
  };
  CsvReader reader(text);
  const auto names = reader.names();
  if (const auto* const fault = std::get_if<CsvFault>(&names)) return fail(*fault);
  std::vector<std::vector<double>> columns(reader.cells().size());
  while (true) {
    const auto next = reader.next();
    if (const auto* const fault = std::get_if<CsvFault>(&next)) return fail(*fault);
    if (!std::get<bool>(next)) break;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const auto number = reader.number(c);
      if (const auto* const fault = std::get_if<CsvFault>(&number)) return fail(*fault);
      columns[c].push_back(std::get<double>(number));
    }
  }
  JsonnetJsonValue* const object = jsonnet_json_make_object(vm);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    JsonnetJsonValue* const list = jsonnet_json_make_array(vm);
    for (const double number : columns[c]) {
      jsonnet_json_array_append(vm, list, jsonnet_json_make_number(vm, number));
    }
    const std::string& name = std::get<std::vector<std::string>>(names)[c];
    jsonnet_json_object_append(vm, object, name.c_str(), list);
  }
  *success = 1;
  return object;
}

void add_callbacks(JsonnetVm* vm, Importer& importer) {
  jsonnet_import_callback(vm, import_file, &importer);
  static constexpr std::array<const char*, 2> parameters{"text", nullptr};
  jsonnet_native_callback(vm, "csv", read_csv, &importer, parameters.data());
}

std::vector<fs::path> allowed_folders(const std::string& file_name, const JsonnetOptions& options) {
  std::vector<fs::path> folders;
  std::error_code code;
  const fs::path own = fs::path(file_name).parent_path();
  folders.push_back(fs::canonical(own.empty() ? fs::path(".") : own, code));
  if (code) folders.clear();
  for (const std::string& folder : options.import_folders) {
    const fs::path real = fs::canonical(folder, code);
    if (!code) folders.push_back(real);
  }
  return folders;
}

/// Numbers, lists, true and the like are values; any other text is a string.
void set_parameter(JsonnetVm* vm, const SceneParameter& parameter) {
  if (nlohmann::json::accept(parameter.value)) {
    jsonnet_tla_code(vm, parameter.name.c_str(), parameter.value.c_str());
  } else {
    jsonnet_tla_var(vm, parameter.name.c_str(), parameter.value.c_str());
  }
}

Evaluation finish(JsonnetVm* vm, char* text, int error) {
  Evaluation evaluation{error == 0, text};
  jsonnet_realloc(vm, text, 0);
  return evaluation;
}

}  // namespace

Evaluation run_program(std::string_view text, const std::string& file_name,
                       const JsonnetOptions& options, const Limits& limits, bool known_function,
                       const std::function<void(const Source&)>& imported) {
  const Vm vm(jsonnet_make());
  jsonnet_max_stack(vm.get(), limits.stack);
  Importer importer{vm.get(), allowed_folders(file_name, options), limits.text, &imported};
  add_callbacks(vm.get(), importer);
  const std::string program(text);
  if (!options.parameters.empty() && !known_function) {
    // Jsonnet does not report parameters that the program does not take.
    int error = 0;
    const Vm judge(jsonnet_make());
    jsonnet_max_stack(judge.get(), limits.stack);
    Importer again = importer;
    again.vm = judge.get();
    add_callbacks(judge.get(), again);
    const std::string question = "std.type(\n" + program + "\n)";
    char* const type =
        jsonnet_evaluate_snippet(judge.get(), file_name.c_str(), question.c_str(), &error);
    const Evaluation told = finish(judge.get(), type, error);
    if (told.good && told.text.find("function") == std::string::npos) {
      return {false,
              "the scene has no parameters: it is not a function; for example "
              "function(load=100) {...}"};
    }
  }
  for (const SceneParameter& parameter : options.parameters) set_parameter(vm.get(), parameter);
  int error = 0;
  char* const made = jsonnet_evaluate_snippet(vm.get(), file_name.c_str(), program.c_str(), &error);
  return finish(vm.get(), made, error);
}

}  // namespace sheave::jsonnet

#endif

#include "scenes/jsonnet/virtual_machine.h"

#if SHEAVE_HAS_JSONNET

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <system_error>

#include <jsonnet_library.h>

// The header does not declare its functions as C functions.
extern "C" {
#include <libjsonnet.h>
}

#include <nlohmann/json.hpp>

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
  const auto& importer = *static_cast<const Importer*>(context);
  const Found found = read_import(importer, base, wanted);
  *success = found.fault.empty() ? 1 : 0;
  if (!found.fault.empty()) return vm_text(importer.vm, found.fault);
  *found_here = vm_text(importer.vm, found.name);
  (*importer.imported)({found.name, found.text});
  return vm_text(importer.vm, found.text);
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
                       const JsonnetOptions& options, const Limits& limits,
                       const std::function<void(const Source&)>& imported) {
  const Vm vm(jsonnet_make());
  jsonnet_max_stack(vm.get(), limits.stack);
  Importer importer{vm.get(), allowed_folders(file_name, options), limits.text, &imported};
  jsonnet_import_callback(vm.get(), import_file, &importer);
  const std::string program(text);
  if (!options.parameters.empty()) {
    // Jsonnet does not report parameters that the program does not take.
    int error = 0;
    const Vm judge(jsonnet_make());
    jsonnet_max_stack(judge.get(), limits.stack);
    Importer again = importer;
    again.vm = judge.get();
    jsonnet_import_callback(judge.get(), import_file, &again);
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

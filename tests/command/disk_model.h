#pragma once
// What a disk may hold after a power loss, from the recorded calls of a program: whatever was not
// synchronised may be missing, and a name may have reached the disk before the content it names, or
// not at all.

#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/command/fault_log.h"

namespace sheave::test {

class DiskModel {
 public:
  /// Files that are on the disk at the start, by their paths.
  explicit DiskModel(const std::map<std::string, std::string>& files)
      : names_(numbered(files)), durable_names_(names_) {
    for (const auto& [path, content] : files) files_.push_back({content, content});
  }

  void apply(const RecordedCall& call) {
    if (call.name == "create") {
      names_[call.first] = open_[call.descriptor] = files_.size();
      files_.push_back({});
    } else if (call.name == "open") {
      open_.erase(call.descriptor);
      const auto known = names_.find(call.first);
      if (known != names_.end()) open_[call.descriptor] = known->second;
    } else if (call.name == "close") {
      open_.erase(call.descriptor);
    } else if (call.name == "rename") {
      const std::size_t file = names_.at(call.first);
      names_.erase(call.first);
      names_[call.second] = file;
      completed_[call.second].insert(files_[file].content);
    } else if (call.name == "unlink") {
      names_.erase(call.first);
    } else if (call.name == "fsync" && !open_.contains(call.descriptor)) {
      durable_names_ = names_;  // a folder
    } else if (open_.contains(call.descriptor)) {
      change(files_[open_[call.descriptor]], call);
    }
  }

  /// What may be under a name after a power loss now.
  [[nodiscard]] std::set<std::string> after_power_loss(const std::string& path) const {
    std::set<std::string> contents;
    for (const Names* names : {&names_, &durable_names_}) {
      const auto found = names->find(path);
      if (found == names->end()) continue;
      contents.insert(files_[found->second].content);
      contents.insert(files_[found->second].durable);
    }
    return contents;
  }
  /// The contents that files had when they were given that name.
  [[nodiscard]] const std::set<std::string>& completed(const std::string& path) {
    return completed_[path];
  }

 private:
  struct File {
    std::string content;
    std::string durable;
  };
  using Names = std::map<std::string, std::size_t>;

  static Names numbered(const std::map<std::string, std::string>& files) {
    Names names;
    for (const auto& [path, content] : files) names.emplace(path, names.size());
    return names;
  }
  static void change(File& file, const RecordedCall& call) {
    const auto offset = static_cast<std::size_t>(call.offset);
    if (call.name == "fsync") file.durable = file.content;
    if (call.name == "write") file.content += call.first;
    if (call.name == "ftruncate") file.content.resize(offset);
    if (call.name == "pwrite") file.content.replace(offset, call.first.size(), call.first);
  }

  std::vector<File> files_;
  Names names_;
  Names durable_names_;
  std::map<int, std::size_t> open_;
  std::map<std::string, std::set<std::string>> completed_;
};

}  // namespace sheave::test

#include "render/video_check.h"

#include <array>
#include <bit>
#include <fstream>
#include <optional>
#include <string_view>

namespace sheave::render {
namespace {

/// A file with random access.
class Bytes {
 public:
  explicit Bytes(const std::string& path) : file_(path, std::ios::binary) {
    file_.seekg(0, std::ios::end);
    size_ = static_cast<std::int64_t>(file_.tellg());
  }
  /// -1 if the file cannot be read.
  [[nodiscard]] std::int64_t size() const { return size_; }
  /// `count` bytes (at most 8) as a number, most significant byte first; nothing beyond the end.
  std::optional<std::uint64_t> number(std::int64_t at, int count) {
    if (at < 0 || at + count > size_) return {};
    std::array<char, 8> bytes{};
    file_.clear();
    file_.seekg(at);
    if (!file_.read(bytes.data(), count)) return {};
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i) {
      value = value << 8U | static_cast<unsigned char>(bytes[static_cast<std::size_t>(i)]);
    }
    return value;
  }

 private:
  std::ifstream file_;
  std::int64_t size_ = -1;
};

/// A piece of either format: its kind, and the begin and end of its content.
struct Piece {
  std::uint64_t kind = 0;
  std::int64_t begin = 0;
  std::int64_t end = 0;
};

/// Reads the piece at `at`; nothing if it does not end at `end` or before.
using Reader = std::optional<Piece> (*)(Bytes& bytes, std::int64_t at, std::int64_t end);

std::optional<Piece> bounded(std::uint64_t kind, std::int64_t begin, std::uint64_t size,
                             std::int64_t end) {
  if (begin > end || size > static_cast<std::uint64_t>(end - begin)) return {};
  return Piece{kind, begin, begin + static_cast<std::int64_t>(size)};
}

constexpr std::uint64_t four(std::string_view name) {
  std::uint64_t value = 0;
  for (const char c : name) value = value << 8U | static_cast<unsigned char>(c);
  return value;
}

/// A box of MP4: its size including this head, four letters, and a size of 64 bits if the box is
/// large.
std::optional<Piece> box_at(Bytes& bytes, std::int64_t at, std::int64_t end) {
  const auto size = bytes.number(at, 4);
  const auto kind = bytes.number(at + 4, 4);
  if (!size || !kind) return {};
  if (*size == 0) return bounded(*kind, at + 8, static_cast<std::uint64_t>(end - at - 8), end);
  if (*size != 1) return *size < 8 ? std::nullopt : bounded(*kind, at + 8, *size - 8, end);
  const auto large = bytes.number(at + 8, 8);
  if (!large || *large < 16) return {};
  return bounded(*kind, at + 16, *large - 16, end);
}

/// An element of Matroska: a number and a size; the leading bits of each give its own length.
std::optional<Piece> element_at(Bytes& bytes, std::int64_t at, std::int64_t end) {
  const auto first = bytes.number(at, 1);
  if (!first || *first < 0x10) return {};
  const int id_length = std::countl_zero(static_cast<std::uint8_t>(*first)) + 1;
  const auto id = bytes.number(at, id_length);
  const auto size_first = bytes.number(at + id_length, 1);
  if (!id || !size_first || *size_first == 0) return {};
  const int size_length = std::countl_zero(static_cast<std::uint8_t>(*size_first)) + 1;
  const auto marked = bytes.number(at + id_length, size_length);
  if (!marked) return {};
  const std::uint64_t mask = (std::uint64_t{1} << (7U * static_cast<unsigned>(size_length))) - 1U;
  // All ones mean an unknown size. An encoder replaces it when it ends properly.
  if ((*marked & mask) == mask) return {};
  return bounded(*id, at + id_length + size_length, *marked & mask, end);
}

/// Calls `use` for the pieces between `begin` and `end`; false if the pieces do not fill the
/// interval.
template <class Use>
bool for_each(Bytes& bytes, Reader reader, std::int64_t begin, std::int64_t end, const Use& use) {
  while (begin < end) {
    const auto piece = reader(bytes, begin, end);
    if (!piece) return false;
    use(*piece);
    begin = piece->end;
  }
  return begin == end;
}

/// The first piece of a kind within another.
std::optional<Piece> find(Bytes& bytes, Reader reader, const std::optional<Piece>& in,
                          std::uint64_t kind) {
  std::optional<Piece> found;
  if (!in) return {};
  const bool whole = for_each(bytes, reader, in->begin, in->end, [&](const Piece& piece) {
    if (piece.kind == kind && !found) found = piece;
  });
  return whole ? found : std::nullopt;
}

Result<std::int64_t> count_mp4(Bytes& bytes) {
  const Piece file{0, 0, bytes.size()};
  std::optional<Piece> table = find(bytes, box_at, file, four("moov"));
  if (!table) return Error{"", "the file ends early: it has no index (moov)"};
  for (const char* name : {"trak", "mdia", "minf", "stbl", "stsz"}) {
    table = find(bytes, box_at, table, four(name));
  }
  const auto data = find(bytes, box_at, file, four("mdat"));
  if (!table || !data) return Error{"", "its index is damaged"};
  // Version and flags; the size of all samples, 0 if each has its own; the number of samples.
  const auto common = bytes.number(table->begin + 4, 4);
  const auto count = bytes.number(table->begin + 8, 4);
  if (!common || !count) return Error{"", "its index is damaged"};
  std::uint64_t sum = *common * *count;
  for (std::uint64_t i = 0; i < *count && *common == 0; ++i) {
    const auto size = bytes.number(table->begin + 12 + 4 * static_cast<std::int64_t>(i), 4);
    if (!size) return Error{"", "its index is damaged"};
    sum += *size;
  }
  if (sum > static_cast<std::uint64_t>(data->end - data->begin)) {
    return Error{"", "pictures are missing that its index tells of"};
  }
  return static_cast<std::int64_t>(*count);
}

Result<std::int64_t> count_matroska(Bytes& bytes) {
  constexpr std::uint64_t segment_id = 0x18538067;
  constexpr std::uint64_t cluster_id = 0x1f43b675;
  constexpr std::uint64_t simple_block_id = 0xa3;
  constexpr std::uint64_t block_group_id = 0xa0;
  const auto segment = find(bytes, element_at, Piece{0, 0, bytes.size()}, segment_id);
  if (!segment) return Error{"", "the file ends early"};
  std::int64_t count = 0;
  bool whole = true;
  const auto count_block = [&](const Piece& block) {
    count += block.kind == simple_block_id || block.kind == block_group_id ? 1 : 0;
  };
  whole &= for_each(bytes, element_at, segment->begin, segment->end, [&](const Piece& piece) {
    if (piece.kind != cluster_id) return;
    whole &= for_each(bytes, element_at, piece.begin, piece.end, count_block);
  });
  if (!whole) return Error{"", "the file is damaged"};
  return count;
}

/// The end of a chain of blocks. Each block begins with its length; the block of length 0 ends the
/// chain.
std::optional<std::int64_t> end_of_chain(Bytes& bytes, std::int64_t at) {
  for (;;) {
    const auto length = bytes.number(at, 1);
    if (!length) return {};
    at += 1 + static_cast<std::int64_t>(*length);
    if (*length == 0) return at;
  }
}

/// Size of the colour table that the flags describe.
std::int64_t table_size(std::uint64_t flags) {
  return (flags & 0x80U) == 0 ? 0 : std::int64_t{3} << ((flags & 7U) + 1U);
}

Result<std::int64_t> count_gif(Bytes& bytes) {
  constexpr std::uint64_t image = 0x2c;
  constexpr std::uint64_t extension = 0x21;
  constexpr std::uint64_t end = 0x3b;
  const Error early{"", "the file ends early"};
  const auto screen = bytes.number(10, 1);
  if (!screen) return early;
  std::int64_t count = 0;
  std::int64_t at = 13 + table_size(*screen);
  for (;;) {
    const auto kind = bytes.number(at, 1);
    if (!kind) return early;
    if (*kind == end) return count;
    std::int64_t chain = at + 2;
    if (*kind == image) {
      const auto flags = bytes.number(at + 9, 1);
      if (!flags) return early;
      chain = at + 11 + table_size(*flags);
      ++count;
    } else if (*kind != extension) {
      return Error{"", "the file is damaged"};
    }
    const auto next = end_of_chain(bytes, chain);
    if (!next) return early;
    at = *next;
  }
}

}  // namespace

Result<std::int64_t> count_video_frames(const std::string& path) {
  constexpr std::uint64_t matroska = 0x1a45dfa3;
  Bytes bytes(path);
  if (bytes.size() < 0) return Error{"", "the file cannot be read"};
  if (bytes.size() == 0) return Error{"", "the file is empty"};
  if (bytes.number(4, 4) == four("ftyp")) return count_mp4(bytes);
  if (bytes.number(0, 4) == matroska) return count_matroska(bytes);
  if (bytes.number(0, 4) == four("GIF8")) return count_gif(bytes);
  return Error{"", "the file is no video"};
}

}  // namespace sheave::render

#pragma once
// Reads NumPy's .npy files as this program writes them: tables of doubles.

#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace sheave::test {

struct NpyFile {
  std::string header;
  std::size_t rows = 0;     // that the header tells
  std::size_t columns = 0;  // likewise
  std::vector<double> data;
};

/// `complete`: whether the data must be exactly what the header tells; otherwise there may be more.
inline NpyFile parse_npy(const std::string& bytes, bool complete = true) {
  NpyFile npy;
  EXPECT_EQ(bytes.substr(0, 6), "\x93NUMPY");
  const bool short_length = bytes.at(6) == 1;
  std::size_t length = 0;
  for (std::size_t i = short_length ? 2 : 4; i-- > 0;) {
    length = length << 8U | static_cast<unsigned char>(bytes.at(8 + i));
  }
  const std::size_t begin = short_length ? 10 : 12;
  EXPECT_EQ((begin + length) % 64, 0U) << "numpy wants aligned data";
  npy.header = bytes.substr(begin, length);
  EXPECT_EQ(npy.header.back(), '\n');
  const std::string shape = "'shape': (";
  const std::size_t at = npy.header.find(shape);
  EXPECT_NE(at, std::string::npos);
  npy.rows = std::stoull(npy.header.substr(at + shape.size()));
  for (std::size_t i = npy.header.find("'<f8'"); i < npy.header.size();
       i = npy.header.find("'<f8'", i + 1)) {
    ++npy.columns;
  }
  const std::size_t size = bytes.size() - begin - length;
  npy.data.resize(size / sizeof(double));
  if (!npy.data.empty()) {
    std::memcpy(npy.data.data(), bytes.data() + begin + length, npy.data.size() * sizeof(double));
  }
  if (complete) {
    EXPECT_EQ(size, npy.rows * npy.columns * sizeof(double));
  }
  return npy;
}

}  // namespace sheave::test

#pragma once
// Reading and comparing pictures.

#include <optional>
#include <string>

#include "render/image.h"

namespace sheave::test {

/// A PNG file as 8-bit RGB; nothing if it cannot be read.
[[nodiscard]] std::optional<render::Image> read_png(const std::string& path);

/// Compares with tests/render/golden/<name>.png. Rasterisers differ in the last bit of an edge's
/// coverage and in which of two samples a line covers, so pictures match if the mean difference of
/// all components is at most 0.7 of 255 and at most 1 % of the pixels differ by more than 32 in a
/// component. On a mismatch the picture is left in the temporary folder. With
/// SHEAVE_UPDATE_GOLDEN=1 in the environment the golden picture is replaced instead. Returns an
/// empty text, or what is wrong.
[[nodiscard]] std::string compare_with_golden(const render::Image& image, const std::string& name);

}  // namespace sheave::test

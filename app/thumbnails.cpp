#include "app/thumbnails.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

#include "core/image/image_file.h"
#include "core/measure/sweep_report.h"

namespace lightvane {
namespace {

std::string base64Text(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

/// The mean of the pixels that each of fewer stands for.
ImageRgb shrunk(const ImageRgb& picture, int width) {
  const int height = std::max(1, picture.height() * width / picture.width());
  ImageRgb small(width, height);
  for (int y = 0; y < height; ++y) {
    const int top = y * picture.height() / height;
    const int bottom = std::max(top + 1, (y + 1) * picture.height() / height);
    for (int x = 0; x < width; ++x) {
      const int left = x * picture.width() / width;
      const int right = std::max(left + 1, (x + 1) * picture.width() / width);
      Rgb sum(0.0f);
      for (int row = top; row < bottom; ++row) {
        for (int column = left; column < right; ++column) sum += picture.at(column, row);
      }
      small.at(x, y) = sum / static_cast<float>((bottom - top) * (right - left));
    }
  }
  return small;
}

Expected<std::string> smallPng(const std::filesystem::path& file) {
  const auto read = readImage(file);
  if (!read) return tl::unexpected(read.error());
  LayeredImage small;
  small.width = std::min(read->width, kThumbnailWidth);
  const ImageRgb pixels = read->width > small.width ? shrunk(read->rgb(), small.width) : read->rgb();
  small.height = pixels.height();
  small.setRgb("", pixels);
  return imageBytes(".png", small);
}

}  // namespace

const std::map<std::string, std::string>& Thumbnails::of(const Sweep& sweep) {
  for (const SweepPoint& point : sweep.points) {
    for (const std::string& name : {point.picture, point.errorMap}) {
      if (name.empty() || addresses_.contains(name)) continue;
      if (const auto png = smallPng(folder_ / name))
        addresses_[name] = "data:image/png;base64," + base64Text(*png);
    }
  }
  return addresses_;
}

}  // namespace lightvane

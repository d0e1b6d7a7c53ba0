#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/parameter.h"

namespace lightvane {

/// Why a picture differs from the truth: DifferenceParts, by name.
enum class ErrorSource : std::uint8_t { Noise, Leaks, Interpolation, SingleDirection, MissingBounces };
inline constexpr std::size_t kErrorSources = 5;
inline constexpr std::array<Choice<ErrorSource>, kErrorSources> kErrorSourceNames{
    {{ErrorSource::Noise, "noise"},
     {ErrorSource::Leaks, "leaks"},
     {ErrorSource::Interpolation, "interpolation"},
     {ErrorSource::SingleDirection, "single-direction"},
     {ErrorSource::MissingBounces, "missing-bounces"}}};

struct ErrorSourceInfo {
  ErrorSource source;
  const char* label;   ///< "Missing bounces"
  const char* help;    ///< one sentence
  const char* remedy;  ///< the parameters that make it smaller
};
/// In the order of ErrorSource.
std::span<const ErrorSourceInfo> errorSourceInfos();

}  // namespace lightvane

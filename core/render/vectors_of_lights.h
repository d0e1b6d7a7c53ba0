#pragma once

namespace lightvane {

/// The rule of `dlv.mode=auto`: whether a light whose exact value takes this many shadow rays is interpolated
/// from Direct Light Vectors. It counts rays, never time, so that all machines decide alike.
bool autoKeepsVectors(int shadowRays);
/// Whether it is not because samples are more accurate than vectors; otherwise because they are cheaper.
bool isBeyondVectors(int shadowRays);

}  // namespace lightvane

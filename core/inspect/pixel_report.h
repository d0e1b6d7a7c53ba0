#pragma once

#include <string>
#include <vector>

#include "core/inspect/explain_point.h"

namespace lightvane {

// Why a pixel shows what it shows. Radiances are in the scene's own units, towards the viewer; places and
// lengths stay in normalised units, and every text has its unit.

/// How one vector fared at a visible point.
struct CandidateReport {
  RecordRef record;
  float distance = 0.0f;        ///< normalised units
  float angle = 0.0f;           ///< between the normals, radians
  float relativeChange = 0.0f;  ///< AB . grad E / E, of ILVs: what its gradient predicts for the point
  float weight = 0.0f;
  Rgb share{0.0f};      ///< of the answer's radiance; black where it was not used
  bool used = false;    ///< it has a share
  bool own = false;     ///< it was computed at this very point
  bool hidden = false;  ///< it has a share, though something stands between (ilv.visibility did not ask)
  std::string rule;     ///< that refused it: "distance"; empty where none did
  std::string verdict;  ///< "used", or by how much the rule refused: "distance 0.12 m > radius 0.1 m"
};

/// The light of one lamp, or what the ILVs of one key gave.
struct AnswerReport {
  std::string name;  ///< of the light, or of what the vectors serve
  AnswerOrigin origin = AnswerOrigin::NotYet;
  Rgb radiance{0.0f};   ///< what the picture has
  Rgb explained{0.0f};  ///< what the shares add up to; of what was computed here, the same as `radiance`
  std::vector<CandidateReport> candidates;  ///< the used ones and the nearest others, by distance
  bool isExact = false;     ///< `explained` is `radiance`, but for rounding: see IndirectSource::isExact
  std::size_t omitted = 0;  ///< candidates that were left out: farther ones, all refused
  std::string note;         ///< a sentence on what is special; often empty
};

/// One point at which the pixel needs light.
struct PointReport {
  PointRef point;
  std::string reached;  ///< "seen straight", "by way of mirror (left wall)"
  Rgb throughput{0.0f};
  Vec3 position{0.0f};
  Vec3 normal{0.0f};
  float clearance = kInfinity;
  std::string material;
  std::string shape;
  std::vector<AnswerReport> lights;    ///< each light, or many without vectors together
  Rgb mirrored{0.0f};                  ///< of lights seen in planar mirrors
  std::vector<AnswerReport> indirect;  ///< each key of the BRDF
  Rgb direct{0.0f};                    ///< of all lights
  Rgb indirectSum{0.0f};               ///< mirrored lights and all keys
  bool throughSpecular = false;
};

struct PixelReport {
  int x = 0;
  int y = 0;
  std::string note;     ///< why there is nothing to report, or what to mind; often empty
  bool coarse = false;  ///< a point was not looked at yet: the picture shows a pixel nearby in its place
  Rgb shown{0.0f};      ///< the beauty picture's value
  // What the report comes to, layer by layer:
  Rgb emission{0.0f};
  Rgb direct{0.0f};
  Rgb indirect{0.0f};
  Rgb specular{0.0f};
  std::vector<PointReport> points;

  Rgb total() const { return emission + direct + indirect + specular; }
};

/// The report of a pixel; `x`, `y` count in the region's picture. Without points, but with `note`, for frames
/// of other methods. Any thread. Cost: below a millisecond for a pixel without mirrors.
PixelReport pixelReport(const RenderFrame& frame, int x, int y);

}  // namespace lightvane

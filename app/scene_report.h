#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/render/parameters.h"
#include "core/scene/scene.h"

namespace lightvane {

/// What there is to say about a scene, as values: `lightvane scene` prints them, --json writes them.
struct SceneReport {
  struct Material {
    std::string name;
    std::vector<std::string> parts;  ///< "diffuse", "lobe", "specular", "glass", "anisotropic", "emission"
    std::size_t shapes = 0;          ///< that use it
  };
  struct Light {
    std::string name;
    std::string kind;  ///< "area", "point", "spot", "directional", "volumic sphere"
    double watts =
        0.0;  ///< radiant power as luminance; of directional lights, what passes the scene's bounding sphere
    int shadowRays = 0;       ///< for its direct light at a point
    bool hasVectors = false;  ///< Direct Light Vectors
    std::string reason;       ///< why or why not
  };
  struct Camera {
    std::string name;
    int width = 0;
    int height = 0;
    std::optional<double> fovYDegrees;         ///< of a perspective one
    std::optional<double> orthographicHeight;  ///< of an orthographic one, in `units`
    double lensRadius = 0.0;                   ///< in `units`; 0 without a lens
    double focusDistance = 0.0;                ///< in `units`, with a lens
  };

  std::string file, name, hash, units;
  double metresPerUnit = 1.0;
  double diagonal = 0.0;                                    ///< in `units`
  std::vector<std::pair<std::string, std::size_t>> shapes;  ///< by kind, those that there are: "polygon", 12
  std::size_t triangles = 0;
  std::vector<Material> materials;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  SceneNeeds needs;
  std::size_t accelerationBytes = 0;  ///< of the structure that rays are traced in
  std::vector<std::string> warnings;
};

/// `parameters` decide which lights have vectors. Builds the acceleration structure to weigh it. Throws
/// LoadStopped as `watch` says.
SceneReport reportScene(const SceneDescription& description, const std::shared_ptr<const Scene>& scene,
                        const Parameters& parameters, LoadWatch& watch = LoadWatch::none());

std::string sceneReportText(const SceneReport& report);
std::string sceneReportJson(const SceneReport& report);

/// What the needs mean, a clause each: "mirrors or glass: visible points are followed through them".
std::vector<std::string> needsInWords(const SceneNeeds& needs);

}  // namespace lightvane

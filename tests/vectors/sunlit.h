#pragma once

#include "core/vectors/gather.h"
#include "tests/support/polygon_scene.h"
#include "tests/trace/scene_builder.h"

namespace lightvane::vectors_test {

/// Indirect light whose amount is known: white rectangles lit by a sun, each of a constant radiance after one
/// reflection (the transport's limit is one), and receivers that are imaginary. The same rectangles as
/// emitters are given to the radiosity oracle's geometry, whose irradiance is exact.
class Sunlit {
 public:
  /// A sun of irradiance pi that shines into `direction`: a rectangle facing it has a radiance of 0.8 cos.
  explicit Sunlit(const Vec3d& direction) : toSun_(-glm::normalize(direction)) {
    white_ = builder_.diffuse(Rgb(kReflectance));
    black_ = builder_.diffuse(Rgb(0.0f));
    grey_ = builder_.diffuse(Rgb(0.5f));
    glossy_ = builder_.glossy(Rgb(0.9f, 0.6f, 0.3f), 0.6);
    builder_.light(DirectionalLightDescription{direction, Rgb(kPi), 0.0});
  }

  /// The front, where u x v points, faces the sun and the receivers.
  void panel(const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
    builder_.rectangle(corner, u, v, white_);
    const double cosine = glm::dot(glm::normalize(glm::cross(u, v)), toSun_);
    LV_CHECK(cosine > 0.0, "a panel's front must face the sun");
    add(corner, u, v, static_cast<double>(kReflectance) * cosine);
  }
  /// Black: hides light, and must not shade a panel.
  void screen(const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
    builder_.rectangle(corner, u, v, black_);
    add(corner, u, v, 0.0);
  }
  /// To be called after the last rectangle.
  void finish() {
    traced_ = std::make_unique<trace_test::TracedScene>(builder_.compile());
    oracle_ = std::make_unique<PolygonScene>(polygons_);
  }

  const trace_test::TracedScene& traced() const { return *traced_; }
  const PolygonScene& oracle() const { return *oracle_; }
  std::size_t grey() const { return grey_; }
  std::size_t glossy() const { return glossy_; }

  static TransportParameters transport() {
    TransportParameters t;
    t.maxBounces = 1;
    return t;
  }

  /// Irradiance in normalised units, exact.
  double irradiance(const Vec3d& point, const Vec3d& normal) const {
    return oracle_->directIrradiance(point, glm::normalize(normal)).x / traced_->unitRadiance();
  }
  /// Its derivative when the point moves, per scene unit, and when the normal turns about `axis`, per radian:
  /// central differences of an exact function.
  double slope(const Vec3d& point, const Vec3d& normal, const Vec3d& along) const {
    const double h = 1e-4;
    return (irradiance(point + h * along, normal) - irradiance(point - h * along, normal)) / (2.0 * h);
  }
  double turnSlope(const Vec3d& point, const Vec3d& normal, const Vec3d& axis) const {
    const double h = 1e-4;
    const Vec3d side = glm::cross(axis, normal);
    return (irradiance(point, normal + h * side) - irradiance(point, normal - h * side)) / (2.0 * h);
  }

  /// The mean of `count` gathers with different seeds.
  struct Mean {
    double irradiance = 0.0;
    Vec3d gradient{0.0};  ///< per scene unit
    Vec3d rotation{0.0};
    Vec3d gradientError{0.0};  ///< standard errors
    Vec3d rotationError{0.0};
  };
  Mean gathers(const Vec3d& point, const Vec3d& normal, const IlvParameters& ilv, int count) const {
    VectorParameters parameters;
    parameters.ilv = ilv;
    Gatherer gatherer(*traced_->tracer, transport(), parameters);
    const GatherPoint at{traced_->imaginaryPoint(point, normal, grey_, normal), 0.01f};
    RayCounts counts;
    SampleFaults faults;
    Mean mean;
    Vec3d gradientSquares(0.0), rotationSquares(0.0);
    for (int i = 0; i < count; ++i) {
      const auto r = gatherer.gather(at, kLambertKey, static_cast<std::uint64_t>(i), counts, faults);
      mean.irradiance += static_cast<double>(r.energy.x) / count;
      const Vec3d gradient = Vec3d(r.gradient[0]) / traced_->unitLength(), rotation(r.rotation[0]);
      mean.gradient += gradient / double(count);
      mean.rotation += rotation / double(count);
      gradientSquares += gradient * gradient / double(count);
      rotationSquares += rotation * rotation / double(count);
    }
    const Vec3d none(0.0);
    mean.gradientError =
        glm::sqrt(glm::max(none, gradientSquares - mean.gradient * mean.gradient) / double(count));
    mean.rotationError =
        glm::sqrt(glm::max(none, rotationSquares - mean.rotation * mean.rotation) / double(count));
    return mean;
  }

 private:
  static constexpr float kReflectance = 0.8f;

  void add(const Vec3d& corner, const Vec3d& u, const Vec3d& v, double radiance) {
    polygons_.push_back({"panel " + std::to_string(polygons_.size()),
                         {corner, corner + u, corner + u + v, corner + v},
                         Vec3d(0.0),
                         Vec3d(radiance)});
  }

  Vec3d toSun_;
  std::size_t white_ = 0, black_ = 0, grey_ = 0, glossy_ = 0;
  trace_test::SceneBuilder builder_;
  std::vector<DiffusePolygon> polygons_;
  std::unique_ptr<trace_test::TracedScene> traced_;
  std::unique_ptr<PolygonScene> oracle_;
};

}  // namespace lightvane::vectors_test

// Point clouds, read back by a small parser of the format as it is published (G. Turk, "The PLY Polygon File
// Format").

#include "core/io/ply_file.h"

#include <cstring>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "core/base/file.h"
#include "tests/io/test_vectors.h"
#include "tests/pictures/pictures.h"
#include "tests/support/temporary_folder.h"

namespace lightvane::test {
namespace {

/// What a reader of PLY knows of the file: a table of numbers.
struct Cloud {
  std::vector<std::string> comments;
  std::vector<std::pair<std::string, std::string>> properties;  ///< type and name
  std::vector<std::map<std::string, double>> vertices;
};

/// The number of `type` at `bytes`, which moves on; of a little-endian machine.
double readNumber(const std::string& type, const char*& bytes) {
  const auto read = [&](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    bytes += sizeof value;
    return static_cast<double>(value);
  };
  if (type == "float") return read(float{});
  if (type == "uchar") return read(std::uint8_t{});
  if (type == "int") return read(std::int32_t{});
  if (type == "uint") return read(std::uint32_t{});
  throw std::runtime_error("a type that is none of PLY's: " + type);
}

Cloud parsePly(const std::string& file) {
  const std::string endOfHeader = "end_header\n";
  const std::size_t end = file.find(endOfHeader);
  if (end == std::string::npos) throw std::runtime_error("the header has no end");
  Cloud cloud;
  std::size_t count = 0;
  std::istringstream header(file.substr(0, end));
  std::string line;
  std::vector<std::string> lines;
  while (std::getline(header, line)) lines.push_back(line);
  EXPECT_EQ(lines.at(0), "ply");
  EXPECT_EQ(lines.at(1), "format binary_little_endian 1.0");
  for (std::size_t i = 2; i < lines.size(); ++i) {
    std::istringstream words(lines[i]);
    std::string keyword, type, name;
    words >> keyword;
    if (keyword == "comment") {
      cloud.comments.push_back(lines[i]);
    } else if (keyword == "element") {
      words >> name >> count;
      EXPECT_EQ(name, "vertex");
    } else {
      EXPECT_EQ(keyword, "property");
      words >> type >> name;
      cloud.properties.emplace_back(type, name);
    }
  }
  const char* bytes = file.data() + end + endOfHeader.size();
  for (std::size_t i = 0; i < count; ++i) {
    std::map<std::string, double> vertex;
    for (const auto& [type, name] : cloud.properties) vertex[name] = readNumber(type, bytes);
    cloud.vertices.push_back(std::move(vertex));
  }
  EXPECT_EQ(bytes, file.data() + file.size()) << "as many bytes as the header says";
  return cloud;
}

/// A room of some metres, in centimetres and far from the origin: nothing of it is normalised.
const char* const kRoom = R"(version = 1
units = "centimetre"
[camera]
position = [5050, 50, 320]
target = [5050, 50, 50]
resolution = [24, 24]
[material.white]
diffuse = [0.7, 0.5, 0.3]
[material.lamp]
emission = [4000, 3000, 2000]
[[shape]]
type = "box"
material = "white"
min = [5000, 0, 0]
max = [5100, 100, 400]
[[shape]]
type = "polygon"
name = "ceiling lamp"
material = "lamp"
vertices = [[5040, 99, 40], [5060, 99, 40], [5060, 99, 60], [5040, 99, 60]]
)";

struct Rendered {
  render_test::Stage stage{render_test::sceneFromText(kRoom)};
  Parameters parameters =
      render_test::parametersWith({{"dlv.mode", "always"}, {"dlv.seed", "30"}, {"ilv.rows", "6"}});
  std::shared_ptr<const Snapshot> snapshot = render_test::picture(stage, parameters).snapshot;
};

Vec3d at(const std::map<std::string, double>& vertex, const std::string& name, const char* parts = "xyz") {
  return {vertex.at(name + parts[0]), vertex.at(name + parts[1]), vertex.at(name + parts[2])};
}

void expectNear(const Vec3d& a, const Vec3d& b, double relative, const char* what) {
  EXPECT_LE(glm::length(a - b), relative * std::max(glm::length(b), 1e-30)) << what;
}

TEST(Ply, EveryVectorIsAVertexInTheScenesUnits) {
  const Rendered rendered;
  const Scene& scene = *rendered.stage.scene;
  ASSERT_NE(scene.normalisation.lengthExponent, 0);
  ASSERT_NE(scene.normalisation.radianceExponent, 0);
  ASSERT_GT(rendered.snapshot->indirect.size(), 10U);
  ASSERT_GT(rendered.snapshot->directCount(), 10U);
  const Cloud cloud = parsePly(
      encodePly(*rendered.snapshot, scene, rendered.parameters.vectors, {"Lightvane 1.2.3", "room.toml"}));
  ASSERT_EQ(cloud.vertices.size(), rendered.snapshot->indirect.size() + rendered.snapshot->directCount());

  const double unit = std::ldexp(1.0, scene.normalisation.lengthExponent);
  const double light = std::ldexp(1.0, scene.normalisation.radianceExponent);
  const VectorRadii radii(rendered.parameters.vectors, scene);
  for (std::size_t i = 0; i < rendered.snapshot->indirect.size(); ++i) {
    const IndirectLightVector& r = rendered.snapshot->indirect[i];
    const auto& v = cloud.vertices[i];
    const Vec3d position = at(v, "");
    expectNear(position, scene.normalisation.centre + unit * Vec3d(r.point.position), 1e-6, "position");
    EXPECT_GT(position.x, 4999.0);
    EXPECT_LT(position.x, 5101.0);
    expectNear(at(v, "n"), Vec3d(r.point.normal), 0.0, "normal");
    expectNear(at(v, "energy_", "rgb"), light * Vec3d(r.energy), 1e-6, "energy");
    expectNear(at(v, "irradiance_", "rgb"), light * Vec3d(r.irradiance), 1e-6, "irradiance");
    expectNear(at(v, "direction_"), Vec3d(r.direction), 0.0, "direction");
    expectNear(at(v, "gradient_green_"), light / unit * Vec3d(r.gradient[1]), 1e-6, "gradient");
    expectNear(at(v, "rotation_blue_"), light * Vec3d(r.rotation[2]), 1e-6, "rotation");
    EXPECT_NEAR(v.at("radius"), unit * static_cast<double>(radii(r)), 1e-6 * v.at("radius"));
    EXPECT_NEAR(v.at("harmonic_mean_distance"), unit * static_cast<double>(r.harmonicMean), 1e-4);
    EXPECT_EQ(v.at("kind"), 0.0);
    EXPECT_EQ(v.at("light"), -1.0);
    EXPECT_EQ(v.at("birth_pass"), r.birth.pass);
    EXPECT_EQ(v.at("birth_order"), r.birth.order);
    EXPECT_EQ(v.at("birth_pixel"), r.birth.pixel);
    EXPECT_EQ(v.at("birth_rays"), r.birth.rays);
  }
  const auto& direct = rendered.snapshot->direct[0];
  for (std::size_t i = 0; i < direct.size(); ++i) {
    const DirectLightVector& r = direct[i];
    const auto& v = cloud.vertices[rendered.snapshot->indirect.size() + i];
    EXPECT_EQ(v.at("kind"), 1.0);
    EXPECT_EQ(v.at("light"), 0.0);
    expectNear(at(v, "energy_", "rgb"), light * Vec3d(r.energy), 1e-6, "energy");
    EXPECT_EQ(v.at("solid_angle"), static_cast<double>(r.solidAngle));
    EXPECT_EQ(v.at("occluded"), r.occluded ? 1.0 : 0.0);
    EXPECT_EQ(v.at("least_distance"), 0.0) << "of ILVs only";
  }
}

TEST(Ply, ColoursAreForTheEye) {
  const Rendered rendered;
  const Cloud cloud = parsePly(encodePly(*rendered.snapshot, *rendered.stage.scene,
                                         rendered.parameters.vectors, {"Lightvane", "room.toml"}));
  std::size_t clipped = 0;
  double sum = 0.0;
  const std::size_t count = rendered.snapshot->indirect.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double red = cloud.vertices[i].at("red");
    clipped += red == 255.0 ? 1 : 0;
    sum += red;
    EXPECT_GE(red, cloud.vertices[i].at("blue")) << "the walls and the lamp are red rather than blue";
  }
  EXPECT_LE(clipped, count / 10);
  EXPECT_GT(sum / static_cast<double>(count), 60.0);
}

TEST(Ply, TheHeaderSaysWhatIsInIt) {
  const Rendered rendered;
  const Cloud cloud = parsePly(encodePly(*rendered.snapshot, *rendered.stage.scene,
                                         rendered.parameters.vectors, {"Lightvane 1.2.3", "a\nroom.toml"}));
  std::string comments;
  for (const std::string& comment : cloud.comments) comments += comment + "\n";
  for (const char* said : {"Lightvane 1.2.3: light vectors of a?room.toml", "of 0.01 m each",
                           "comment energy_r: irradiance", "comment radius: "}) {
    EXPECT_NE(comments.find(said), std::string::npos) << said << " in\n" << comments;
  }
  // The names that other programs look for, with their types.
  const std::vector<std::pair<std::string, std::string>> first(cloud.properties.begin(),
                                                               cloud.properties.begin() + 9);
  EXPECT_EQ(first, (std::vector<std::pair<std::string, std::string>>{{"float", "x"},
                                                                     {"float", "y"},
                                                                     {"float", "z"},
                                                                     {"float", "nx"},
                                                                     {"float", "ny"},
                                                                     {"float", "nz"},
                                                                     {"uchar", "red"},
                                                                     {"uchar", "green"},
                                                                     {"uchar", "blue"}}));
}

// Any bits in any field: infinite distances, values that are not numbers.
TEST(Ply, AnyVectorsMakeAWholeFile) {
  const Snapshot snapshot = RandomVectors(3).snapshot(200);
  const TemporaryFolder folder;
  const auto path = folder / "cloud.ply";
  ASSERT_TRUE(writePly(path, snapshot, *cornellScene().scene, VectorParameters{}, {"Lightvane", "cornell"}));
  EXPECT_EQ(folder.files(), std::vector<std::string>{"cloud.ply"});
  const Cloud cloud = parsePly(readFile(path).value());
  EXPECT_EQ(cloud.vertices.size(), 200U * (1 + cornellScene().scene->lights.size()));
  EXPECT_FALSE(
      writePly(folder / "missing" / "a.ply", snapshot, *cornellScene().scene, VectorParameters{}, {}));
  EXPECT_EQ(parsePly(encodePly({}, *cornellScene().scene, VectorParameters{}, {})).vertices.size(), 0U);
}

TEST(Ply, ItsPathsAreKnownInAnyCase) {
  EXPECT_TRUE(isPlyPath("a/b.ply"));
  EXPECT_TRUE(isPlyPath("b.PLY"));
  EXPECT_FALSE(isPlyPath("ply"));
  EXPECT_FALSE(isPlyPath("a.ply.lvcache"));
}

}  // namespace
}  // namespace lightvane::test

#include "tests/bench/large.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include <fmt/format.h>

#include "core/render/renderer.h"
#include "core/scene/load_scene.h"
#include "tests/bench/measure.h"
#include "tests/bench/workbench.h"
#include "tests/support/grid_mesh.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

constexpr int kRings = 50;  // of a ball: 2 * kRings^2 triangles
constexpr double kRoom = 4.0;
constexpr int kSize = 256;

void put(std::ofstream& file, std::uint32_t bits) {
  const char bytes[] = {static_cast<char>(bits & 0xffU), static_cast<char>(bits >> 8 & 0xffU),
                        static_cast<char>(bits >> 16 & 0xffU), static_cast<char>(bits >> 24)};
  file.write(bytes, sizeof bytes);
}

/// One ball in each room, all in one file.
void writeBalls(const fs::path& path, int rooms) {
  constexpr int kVertices = (kRings + 1) * (kRings + 1);
  std::ofstream file(path, std::ios::binary);
  file << fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nelement face {}\nproperty list uchar uint vertex_indices\nend_header\n",
      rooms * kVertices, rooms * 2 * kRings * kRings);
  for (int room = 0; room < rooms; ++room) {
    for (int i = 0; i <= kRings; ++i) {
      for (int j = 0; j <= kRings; ++j) {
        const double theta = kPiD * (i + 0.5) / (kRings + 1), phi = 2.0 * kPiD * (j % kRings) / kRings;
        const double radius = 0.5 + 0.03 * std::sin(9.0 * theta) * std::cos(7.0 * phi);
        for (const double x : {room * kRoom + radius * std::sin(theta) * std::cos(phi),
                               0.6 + radius * std::cos(theta), radius * std::sin(theta) * std::sin(phi)})
          put(file, std::bit_cast<std::uint32_t>(static_cast<float>(x)));
      }
    }
  }
  const std::vector<glm::uvec3> triangles = test::gridTriangles(kRings, kRings);
  for (int room = 0; room < rooms; ++room) {
    for (const glm::uvec3& t : triangles) {
      file.put(3);
      for (int corner = 0; corner < 3; ++corner)
        put(file, static_cast<std::uint32_t>(room * kVertices) + t[corner]);
    }
  }
}

/// Rooms with a lamp each in a row, and about the row lamps that no room sees.
struct Place {
  int rooms = 1;
  int lampsAround = 0;
  bool ballsGlow = false;
};

fs::path writeRooms(const fs::path& folder, const Place& place) {
  const int rooms = place.rooms;
  writeBalls(folder / "balls.ply", rooms);
  std::ofstream file(folder / "rooms.toml");
  file << fmt::format(R"(version = 1
[camera]
position = [-1.6, 1.6, 1.7]
target = [0.2, 0.7, 0]
fov_y = 60
resolution = [{0}, {0}]
[material.wall]
diffuse = [0.7, 0.68, 0.62]
[material.ball]
diffuse = [0.3, 0.4, 0.6]
[material.lamp]
emission = [12, 11, 9]
[[shape]]
type = "mesh"
file = "balls.ply"
material = "{1}"
)",
                      kSize, place.ballsGlow ? "lamp" : "ball");
  for (int room = 0; room < rooms; ++room) {
    const double x = room * kRoom;
    file << fmt::format(R"([[shape]]
type = "box"
material = "wall"
min = [{}, 0, -2]
max = [{}, 2.6, 2]
[[shape]]
type = "disc"
material = "lamp"
center = [{}, 2.55, 0]
normal = [0, -1, 0]
radius = 0.3
)",
                        x - 0.5 * kRoom, x + 0.5 * kRoom, x);
  }
  for (int lamp = 0; lamp < place.lampsAround; ++lamp) {
    const double angle = 2.0 * kPiD * lamp / place.lampsAround;
    file << fmt::format(
        "[[shape]]\ntype = \"sphere\"\nmaterial = \"lamp\"\ncenter = [{}, {}, {}]\nradius = 0.1\n",
        2.0 * kRoom * std::cos(angle), 1.3 + 2.0 * std::sin(7.0 * angle), 2.0 * kRoom * std::sin(angle));
  }
  return folder / "rooms.toml";
}

}  // namespace

std::string largeTable(int rounds) {
  const fs::path folder =
      fs::temp_directory_path() / fmt::format("lightvane-large-{}", std::random_device()());
  fs::create_directories(folder);
  std::string text = fmt::format(
      "### Large scenes: a picture of {0} x {0} of one room among many\n\n"
      "| rooms | lights | triangles | of these glow | read, s | compiled, s | tree, s | picture, s | with "
      "`dlv.mode=always`, "
      "s "
      "|\n|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
      kSize);
  for (const Place& place :
       {Place{1, 0}, Place{20, 0}, Place{200, 0}, Place{1, 200}, Place{1, 2000}, Place{.ballsGlow = true}}) {
    const fs::path path = writeRooms(folder, place);
    const double begun = processCpuSeconds();
    const auto description = loadScene(path);
    const double read = processCpuSeconds();
    const auto scene = description ? Scene::compile(*description) : tl::unexpected(description.error());
    if (!scene) {
      fmt::print(stderr, "{}\n", scene.error().message());
      std::exit(2);
    }
    const double compiled = processCpuSeconds();
    const BenchScene bench("rooms", *scene);
    const double built = processCpuSeconds();
    const auto pool = std::make_shared<TaskPool>(1);
    Parameters always = balanced(Method::Vectors);
    always.vectors.dlv.mode = DlvMode::Always;
    const auto seconds = [&](const Parameters& parameters) {
      return [&bench, &pool, parameters] {
        return render(bench, parameters, wholePicture(kSize), pool).cpuSeconds;
      };
    };
    const std::vector<Samples> pictures = inTurn(
        rounds, std::vector<std::function<double()>>{seconds(balanced(Method::Vectors)), seconds(always)});
    const int glowing = place.ballsGlow ? place.rooms * 2 * kRings * kRings : 0;
    text += fmt::format("| {} | {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {} | {} |\n", place.rooms,
                        (*scene)->lights.size(), (*scene)->triangleCount(), glowing, read - begun,
                        compiled - read, built - compiled, withSpread(pictures[0], 2),
                        withSpread(pictures[1], 2));
  }
  fs::remove_all(folder);
  return text;
}

}  // namespace lightvane

#include "tests/support/cornell.h"

namespace lightvane {
namespace {

const Vec3d kWhite{0.725, 0.71, 0.68};
const Vec3d kRed{0.63, 0.065, 0.05};
const Vec3d kGreen{0.14, 0.45, 0.091};
const Vec3d kBlack{0.0};
const Vec3d kLight{17.0, 12.0, 4.0};  // W/(m² sr)

}  // namespace

std::vector<DiffusePolygon> cornellBox() {
  const auto wall = [](const char* name, std::vector<Vec3d> vertices, const Vec3d& reflectance) {
    return DiffusePolygon{name, std::move(vertices), reflectance, Vec3d(0.0)};
  };
  return {
      wall("floor", {{0.5528, 0, 0}, {0, 0, 0}, {0, 0, 0.5592}, {0.5496, 0, 0.5592}}, kWhite),
      {"light",
       {{0.343, 0.5483, 0.227}, {0.343, 0.5483, 0.332}, {0.213, 0.5483, 0.332}, {0.213, 0.5483, 0.227}},
       kBlack,
       kLight},
      wall("ceiling", {{0.556, 0.5488, 0}, {0.556, 0.5488, 0.5592}, {0, 0.5488, 0.5592}, {0, 0.5488, 0}},
           kWhite),
      wall("back", {{0.5496, 0, 0.5592}, {0, 0, 0.5592}, {0, 0.5488, 0.5592}, {0.556, 0.5488, 0.5592}},
           kWhite),
      wall("right", {{0, 0, 0.5592}, {0, 0, 0}, {0, 0.5488, 0}, {0, 0.5488, 0.5592}}, kGreen),
      wall("left_a", {{0.5528, 0, 0}, {0.5496, 0, 0.5592}, {0.556, 0.5488, 0.5592}}, kRed),
      wall("left_b", {{0.5528, 0, 0}, {0.556, 0.5488, 0.5592}, {0.556, 0.5488, 0}}, kRed),
      wall("short_0",
           {{0.130, 0.165, 0.065}, {0.082, 0.165, 0.225}, {0.240, 0.165, 0.272}, {0.290, 0.165, 0.114}},
           kWhite),
      wall("short_1", {{0.290, 0, 0.114}, {0.290, 0.165, 0.114}, {0.240, 0.165, 0.272}, {0.240, 0, 0.272}},
           kWhite),
      wall("short_2", {{0.130, 0, 0.065}, {0.130, 0.165, 0.065}, {0.290, 0.165, 0.114}, {0.290, 0, 0.114}},
           kWhite),
      wall("short_3", {{0.082, 0, 0.225}, {0.082, 0.165, 0.225}, {0.130, 0.165, 0.065}, {0.130, 0, 0.065}},
           kWhite),
      wall("short_4", {{0.240, 0, 0.272}, {0.240, 0.165, 0.272}, {0.082, 0.165, 0.225}, {0.082, 0, 0.225}},
           kWhite),
      wall("tall_0",
           {{0.423, 0.330, 0.247}, {0.265, 0.330, 0.296}, {0.314, 0.330, 0.456}, {0.472, 0.330, 0.406}},
           kWhite),
      wall("tall_1", {{0.423, 0, 0.247}, {0.423, 0.330, 0.247}, {0.472, 0.330, 0.406}, {0.472, 0, 0.406}},
           kWhite),
      wall("tall_2", {{0.472, 0, 0.406}, {0.472, 0.330, 0.406}, {0.314, 0.330, 0.456}, {0.314, 0, 0.456}},
           kWhite),
      wall("tall_3", {{0.314, 0, 0.456}, {0.314, 0.330, 0.456}, {0.265, 0.330, 0.296}, {0.265, 0, 0.296}},
           kWhite),
      wall("tall_4", {{0.265, 0, 0.296}, {0.265, 0.330, 0.296}, {0.423, 0.330, 0.247}, {0.423, 0, 0.247}},
           kWhite),
  };
}

DiffusePolygon cornellFront() {
  return {"front", {{0, 0, 0}, {0.5528, 0, 0}, {0.556, 0.5488, 0}, {0, 0.5488, 0}}, kBlack, Vec3d(0.0)};
}

std::vector<DiffusePolygon> furnaceCube(const Vec3d& reflectance, const Vec3d& emission) {
  std::vector<DiffusePolygon> walls;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {0.0, 1.0}) {
      // u, v and the axis are right-handed, so that counter-clockwise in (u, v) is a normal along +axis:
      // right for the wall at 0, and the wrong way round for the one at 1.
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      std::vector<Vec3d> vertices;
      for (const auto& [a, b] : {std::pair(0.0, 0.0), {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) {
        Vec3d corner;
        corner[axis] = side;
        corner[u] = side == 0.0 ? a : b;
        corner[v] = side == 0.0 ? b : a;
        vertices.push_back(corner);
      }
      walls.push_back({std::string(side == 0.0 ? "-" : "+") + "xyz"[axis], vertices, reflectance, emission});
    }
  }
  return walls;
}

}  // namespace lightvane

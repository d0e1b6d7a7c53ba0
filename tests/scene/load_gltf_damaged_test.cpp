// glTF files that are damaged, strange or hostile: each gets its message, and nothing is read of it.

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/scene.h"
#include "tests/scene/gltf_text.h"

namespace lightvane {
namespace {

using test::GltfFolder;
using test::GltfText;
using testing::HasSubstr;

struct DamagedGltf {
  std::string name;
  std::string bytes;
  std::string message;
};
void PrintTo(const DamagedGltf& file, std::ostream* out) { *out << file.name; }

std::string withPart(const std::string& key, const std::string& json) {
  return GltfText().triangle().set(key, json).gltf();
}
std::string withAttributes(const std::string& attributes, const std::string& more = "") {
  return GltfText()
      .triangle()
      .set("meshes", R"([{"primitives":[{"attributes":{)" + attributes + "}" + more + "}]}]")
      .gltf();
}
/// The triangle's accessor with other numbers; the view has 36 bytes.
std::string withAccessor(const std::string& json) { return withPart("accessors", "[" + json + "]"); }
std::string withPositions(std::initializer_list<float> numbers) {
  GltfText text;
  text.positions(numbers);
  return text.set("meshes", R"([{"primitives":[{"attributes":{"POSITION":0}}]}])").gltf();
}
std::string withIndices(int type, const std::string& bytes) {
  GltfText text;
  text.accessor(text.view(bytes), type, 3, "SCALAR");
  return text.triangle("", R"(,"indices":0)").gltf();
}
std::string withUri(const std::string& uri) { return GltfText().triangle().json(uri); }
std::string withCamera(const std::string& json, const std::string& node = "") {
  GltfText text = GltfText().triangle();
  return text.set("cameras", "[" + json + "]")
      .set("nodes", R"([{"mesh":0},{"camera":0)" + node + "}]")
      .gltf();
}
std::string withGltfLight(const std::string& json) {
  GltfText text = GltfText().triangle();
  text.set("extensions", R"({"KHR_lights_punctual":{"lights":[)" + json + "]}}");
  return text.set("nodes", R"([{"mesh":0,"extensions":{"KHR_lights_punctual":{"light":0}}}])").gltf();
}
std::string nested(std::size_t depth) {
  return withPart("extras", std::string(depth, '[') + std::string(depth, ']'));
}
std::string changed(std::string bytes, std::size_t at, const std::string& with) {
  return bytes.replace(at, with.size(), with);
}

const float kInf = std::numeric_limits<float>::infinity();
const std::string kSparse =
    R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":)";
const std::string kGlb = GltfText().triangle().glb();

const std::vector<DamagedGltf> kDamagedFiles = {
    // the file
    {"Empty", "", "its JSON is damaged: parse error at line 1, column 1"},
    {"NoJson", "solid teapot", "its JSON is damaged"},
    {"Nul", std::string(100, '\0'), "its JSON is damaged"},
    {"NoObject", "[1, 2]", "is no glTF file: its JSON is not an object"},
    {"EmptyArray", "[]", "is no glTF file: its JSON is not an object"},
    {"NumberAlone", "17", "is no glTF file: its JSON is not an object"},
    {"EmptyObject", "{}", "is no glTF file: its JSON has no \"asset\""},
    {"NoAsset", "{\"a\":1}", "is no glTF file: its JSON has no \"asset\""},
    {"Version1", withPart("asset", R"({"version":"1.0"})"), "is glTF 1.0: 2.0 is read"},
    {"NeedsLaterVersion", withPart("asset", R"({"version":"2.1","minVersion":"2.1"})"), "needs glTF 2.1"},
    {"NonUtf8Name", withPart("nodes", "[{\"mesh\":0,\"name\":\"\xff\"}]"), "ill-formed UTF-8 byte"},
    {"TooDeep", nested(200), "values nested deeper than 100"},
    {"MuchTooDeep", nested(1'000'000), "values nested deeper than 100"},
    {"HugeNumber", withPart("extras", "1e999"), "its JSON is damaged"},
    {"NeedsUnknownExtension", withPart("extensionsRequired", R"(["EXT_moon"])"),
     "it needs the extension EXT_moon, which is not read"},
    {"Draco", withPart("extensionsRequired", R"(["KHR_draco_mesh_compression"])"),
     "which is not read (export it without compression)"},
    {"Meshopt", withPart("extensionsRequired", R"(["EXT_meshopt_compression"])"), "without compression"},
    {"NoTriangles", R"({"asset":{"version":"2.0"}})", "it has no triangles"},
    {"EmptyMeshes", withPart("meshes", R"([{"primitives":[]}])"), "it has no triangles"},

    // buffers
    {"BufferMissing", withUri("none.bin"), "buffer 0: "},
    {"BufferMissingNamed", withUri("none.bin"), "none.bin: no such file"},
    {"BufferAbsolute", withUri("/etc/passwd"), R"(buffer 0: "/etc/passwd" is not relative to the file)"},
    {"BufferFileUri", withUri("file:///etc/passwd"), "is not relative to the file"},
    {"BufferOnADrive", withUri("C:\\\\data.bin"), "is not relative to the file"},
    {"BufferFromTheNet", withUri("https://example.org/a.bin"), "is not relative to the file"},
    {"BufferAbove", withUri("../a.gltf"), R"(buffer 0: "../a.gltf" lies outside the file's folder)"},
    {"BufferAboveInDisguise", withUri("sub/%2e%2e/%2E./a.gltf"), "lies outside the file's folder"},
    {"BufferAboveByBackslash", withUri("..\\\\a.gltf"), "lies outside the file's folder"},
    {"BufferNul", withUri("a%00.bin"), "names no file"},
    {"BufferNotUtf8", withUri("%ff%fe.bin"), "no such file"},
    {"BufferIsAFolder", withUri("."), "is not a regular file"},
    {"BufferOtherUri", withUri("data:text/html,hello"), "is of another kind than base64"},
    {"BufferNoUri", GltfText().triangle().json(""), "buffer 0 has no uri"},
    {"BufferShort", withPart("buffers", R"([{"byteLength":100000,"uri":"a.gltf"}])"),
     "of 100000 that the buffer says"},
    {"BufferUriShort",
     withPart("buffers", R"([{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAA"}])"),
     "buffer 0: its data: URI has 3 bytes, of 36 that the buffer says"},
    {"BufferUriWithAQuote",
     withPart("buffers", R"([{"byteLength":36,"uri":"data:application/octet-stream;base64,AA\"A"}])"),
     "Failed to decode 'uri'"},
    {"BufferHuge", withPart("buffers", R"([{"byteLength":1000000000000000000,"uri":"a.gltf"}])"),
     "buffer 0 would have 1000000000000000000 bytes"},
    {"BuffersHugeTogether",
     withPart("buffers",
              R"([{"byteLength":5000000000,"uri":"a.gltf"},{"byteLength":5000000000,"uri":"a.gltf"}])"),
     "buffer 1 would have 5000000000 bytes: more than 8 GiB in all"},
    {"BufferEmpty", withPart("buffers", R"([{"byteLength":0,"uri":"a.gltf"}])"), "buffer 0 has no bytes"},
    {"BufferNegative", withPart("buffers", R"([{"byteLength":-1,"uri":"a.gltf"}])"), "buffer 0 has no bytes"},
    {"BuffersTwice", R"({"asset":{"version":"2.0"},"buffers":[],"buffers":[]})", "it has buffers twice"},

    // views and accessors
    {"ViewBeyondBuffer", withPart("bufferViews", R"([{"buffer":0,"byteOffset":8,"byteLength":36}])"),
     "view 0: 36 bytes from 8 on do not fit into buffer 0 of 36"},
    {"ViewOverflow",
     withPart("bufferViews", R"([{"buffer":0,"byteOffset":18446744073709551608,"byteLength":36}])"),
     "do not fit into buffer 0"},
    {"ViewOfNoBuffer", withPart("bufferViews", R"([{"buffer":7,"byteLength":36}])"),
     "view 0 names buffer 7, and there are 1"},
    {"ViewStrideOdd", withPart("bufferViews", R"([{"buffer":0,"byteLength":36,"byteStride":13}])"),
     "Invalid `byteStride' value"},
    {"AccessorOfNoView", withAccessor(R"({"bufferView":3,"componentType":5126,"count":3,"type":"VEC3"})"),
     "POSITION of mesh 0, primitive 0 names view 3, and there are 1"},
    {"AccessorBeyondView", withAccessor(R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"})"),
     "POSITION of mesh 0, primitive 0: 4 elements of 12 bytes from byte 0 on do not fit into view 0 of 36 "
     "bytes"},
    {"AccessorHuge",
     withAccessor(R"({"bufferView":0,"componentType":5126,"count":1537228672809129302,"type":"VEC3"})"),
     "its meshes have more than 67108864 vertices and triangles"},
    {"AccessorLarge", withAccessor(R"({"bufferView":0,"componentType":5126,"count":40000000,"type":"VEC3"})"),
     "40000000 elements of 12 bytes from byte 0 on do not fit"},
    {"AccessorOffsetHuge",
     withAccessor(
         R"({"bufferView":0,"byteOffset":18446744073709551615,"componentType":5126,"count":3,"type":"VEC3"})"),
     "do not fit"},
    {"AccessorHugeWithoutBytes",
     withAccessor(R"({"componentType":5126,"count":1000000000000,"type":"VEC3"})"),
     "its meshes have more than 67108864"},
    {"AccessorOfNothing", withAccessor(R"({"componentType":5126,"count":2000000,"type":"VEC3"})"),
     "2000000 elements without bytes"},
    {"NormalsHugeWithoutBytes",
     [] {
       GltfText text;
       text.triangle(R"(,"NORMAL":1)");
       text.accessors.push_back(R"({"componentType":5126,"count":1000000000000,"type":"VEC3"})");
       return text.gltf();
     }(),
     "NORMAL of mesh 0, primitive 0 has 1000000000000 elements, and there are 3 positions"},
    {"AccessorOfDoubles", withAccessor(R"({"bufferView":0,"componentType":5130,"count":1,"type":"VEC3"})"),
     "numbers of type 5130"},
    {"AccessorOfMatrices", withAccessor(R"({"bufferView":0,"componentType":5126,"count":1,"type":"MAT2"})"),
     "expected 3 numbers each, found a matrix"},
    {"AccessorOfScalars", withAccessor(R"({"bufferView":0,"componentType":5126,"count":3,"type":"SCALAR"})"),
     "expected 3 numbers each, found 1"},
    {"SparseIndexOutside",
     withAccessor(
         kSparse +
         R"(1,"indices":{"bufferView":0,"byteOffset":12,"componentType":5125},"values":{"bufferView":0}}})"),
     "a sparse index is 1065353216, and there are 3"},
    {"SparseBeyondView",
     withAccessor(kSparse +
                  R"(99,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}})"),
     "sparse indices: 99 elements of 1 bytes"},
    {"SparseNegative",
     withAccessor(kSparse +
                  R"(-1,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}})"),
     "-1 sparse elements"},

    // meshes
    {"NanPosition", withPositions({0, 0, 0, 1, 0, 0, 0, NAN, 0}),
     "POSITION of mesh 0, primitive 0: vertex 2 is at [0, nan, 0]: expected finite numbers"},
    {"InfinitePosition", withPositions({0, kInf, 0, 1, 0, 0, 0, 1, 0}), "vertex 0 is at [0, inf, 0]"},
    {"IndexOutside", withIndices(test::kUshort, test::littleEndian<std::uint16_t>({0, 1, 3})),
     "indices of mesh 0, primitive 0: index 2 is 3, and there are 3 vertices"},
    {"IndexHuge", withIndices(test::kUint, test::littleEndian<std::uint32_t>({0, 1, 0xffffffff})),
     "is 4294967295"},
    {"IndicesOfFloats", withIndices(test::kFloat, test::floats({0, 1, 2})),
     "expected whole numbers of 1, 2 or 4"},
    {"NoSuchMaterial", withAttributes(R"("POSITION":0)", R"(,"material":2)"),
     "mesh 0 names material 2, and there are 0"},
    {"NoSuchAccessor", withAttributes(R"("POSITION":5)"), "mesh 0 names accessor 5, and there are 1"},
    {"NoSuchNegativeAccessor", withAttributes(R"("POSITION":-4)"), "mesh 0 names accessor -4"},
    {"NoSuchMode", withAttributes(R"("POSITION":0)", R"(,"mode":9)"), "there is no mode 9"},
    {"NoAttributes", withPart("meshes", R"([{"primitives":[{"mode":4}]}])"),
     "'attributes' property is missing in Primitive"},
    {"OddNormals",
     [] {
       GltfText text;
       return text.triangle(fmt::format(R"(,"NORMAL":{})", text.positions({0, 0, 1}))).gltf();
     }(),
     "NORMAL of mesh 0, primitive 0 has 1 elements, and there are 3 positions"},

    // nodes
    {"NodeIsItsOwnChild", withPart("nodes", R"([{"mesh":0,"children":[0]}])"),
     "node 0 is below itself: the nodes above it form a cycle"},
    {"NodesInACircle", withPart("nodes", R"([{"mesh":0},{"children":[2]},{"children":[1],"name":"b"}])"),
     "node 1 is below itself"},
    {"NodeWithTwoParents", withPart("nodes", R"([{"children":[2]},{"children":[2]},{"mesh":0,"name":"x"}])"),
     "node 2 (x) has two parents: nodes 0 and 1"},
    {"RootBelowANode", withPart("nodes", R"([{"children":[1]},{"mesh":0}],"scenes":[{"nodes":[1]}])"),
     "node 1 is at the top of the scene and below node 0"},
    {"RootTwice", withPart("scenes", R"([{"nodes":[0,0]}])"), "the scene has node 0 twice"},
    {"NoSuchRoot", withPart("scenes", R"([{"nodes":[4]}])"), "scene 0 names node 4, and there are 1"},
    {"NoSuchScene", withPart("scene", "2"), "the file names scene 2, and there are 0"},
    {"NoSuchChild", withPart("nodes", R"([{"children":[-1]}])"), "node 0 names node -1"},
    {"NoSuchMesh", withPart("nodes", R"([{"mesh":1}])"), "node 0 names mesh 1, and there are 1"},
    {"ShortMatrix", withPart("nodes", R"([{"mesh":0,"matrix":[1,2,3]}])"), "its matrix is not of 16 numbers"},
    {"ProjectiveMatrix", withPart("nodes", R"([{"mesh":0,"matrix":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]}])"),
     "the last row of its matrix"},
    {"LongScale", withPart("nodes", R"([{"mesh":0,"scale":[1,1,1,1]}])"), "its scale is not of 3 numbers"},
    {"NoRotation", withPart("nodes", R"([{"mesh":0,"rotation":[0,0,0,0]}])"), "its rotation has no length"},
    {"TooManyVertices",
     [] {
       // Nothing of it takes bytes but the meshes: zeros, 16 million vertices each.
       GltfText text;
       text.set("accessors", R"([{"componentType":5126,"count":16000000,"type":"VEC3"}])");
       std::string meshes, nodes;
       for (int i = 0; i < 5; ++i) {
         const char* comma = i == 0 ? "" : ",";
         meshes += fmt::format(R"({}{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}})", comma);
         nodes += fmt::format(R"({}{{"mesh":{}}})", comma, i);
       }
       return text.set("meshes", "[" + meshes + "]").set("nodes", "[" + nodes + "]").gltf();
     }(),
     "its meshes have more than 67108864 vertices and triangles"},

    // cameras and lights
    {"NoSuchCamera", withPart("nodes", R"([{"mesh":0,"camera":0}])"),
     "node 0 names camera 0, and there are 0"},
    {"CameraTooWide", withCamera(R"({"type":"perspective","perspective":{"yfov":4,"znear":1}})"),
     "camera 0: expected a yfov above 0 and below pi, found 4"},
    {"CameraWithoutExtent",
     withCamera(R"({"type":"orthographic","orthographic":{"xmag":1,"ymag":0,"znear":1,"zfar":2}})"),
     "its picture has no extent"},
    {"CameraLooksNowhere",
     withCamera(R"({"type":"perspective","perspective":{"yfov":1,"znear":1}})", R"(,"scale":[0,0,0])"),
     "camera 0 looks nowhere"},
    {"CameraOfNoType", withCamera(R"({"type":"fisheye"})"), "Invalid camera type"},
    {"NoSuchLight", withPart("nodes", R"([{"mesh":0,"extensions":{"KHR_lights_punctual":{"light":0}}}])"),
     "node 0 names light 0, and there are 0"},
    {"NegativeLight", withGltfLight(R"({"type":"point","intensity":-1})"),
     "light 0: its color and intensity are no power"},
    {"LightNowhere",
     GltfText()
         .triangle()
         .set("extensions", R"({"KHR_lights_punctual":{"lights":[{"type":"point"}]}})")
         .set("nodes", R"([{"mesh":0},{"scale":[1e200,1,1],"children":[2]},{"translation":[1e200,0,0],
           "extensions":{"KHR_lights_punctual":{"light":0}}}])")
         .gltf(),
     "light 0: a coordinate is not a finite number"},
    {"LightOfNoType", withGltfLight(R"({"type":"moon"})"), "light 0: expected point, spot or directional"},
    {"NoSuchTexture", withPart("materials", R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":3}}}])"),
     "material 0 names texture 3, and there are 0"},
    {"PictureInNoView", withPart("images", R"([{"bufferView":9}])"), "image[0] bufferView \"9\" not found"},
    {"PictureNowhere", withPart("images", R"([{}])"), "Neither required `bufferView` nor `uri` defined"},
    {"NoSuchPicture", withPart("textures", R"([{"source":3}])"),
     "texture 0 names picture 3, and there are 0"},

    // GLB
    {"GlbHeaderAlone", kGlb.substr(0, 12), "is cut off within its header"},
    {"GlbVersion1", changed(kGlb, 4, test::littleEndian<std::uint32_t>({1})), "is GLB version 1: expected 2"},
    {"GlbCut", kGlb.substr(0, kGlb.size() - 1), "is cut off: it says it has"},
    {"GlbJsonTooLong", changed(kGlb, 12, test::littleEndian<std::uint32_t>({0xfffffff0})),
     "its JSON part does not fit into it"},
    {"GlbNoJson", changed(kGlb, 16, "NOSJ"), "expected its JSON part, found another"},
    {"GlbBinaryTooLong", changed(kGlb, kGlb.size() - 44, test::littleEndian<std::uint32_t>({40})),
     "its binary part does not fit into it"},
    {"GlbBinaryLacks", GltfText().triangle().set("buffers", R"([{"byteLength":99}])").glb(),
     "Invalid `byteLength'"},
    {"GlbTwoOwnBuffers",
     GltfText().triangle().set("buffers", R"([{"byteLength":36},{"byteLength":36}])").glb(),
     "buffer 1 has no uri"},
};

class LoadGltfRefuses : public testing::TestWithParam<DamagedGltf>, protected GltfFolder {};

TEST_P(LoadGltfRefuses, Damaged) {
  EXPECT_THAT(refusal(GetParam().bytes),
              testing::AllOf(testing::StartsWith("a.gltf: "), HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(Files, LoadGltfRefuses, testing::ValuesIn(kDamagedFiles),
                         [](const testing::TestParamInfo<DamagedGltf>& file) { return file.param.name; });

class LoadGltfStrange : public testing::Test, protected GltfFolder {};

TEST_F(LoadGltfStrange, TakesTrianglesWithoutAreaFromWhatHasOthers) {
  GltfText text;
  text.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 2, 2, 2, 2, 2, 3, 3, 3});
  text.set("meshes", R"([{"primitives":[{"attributes":{"POSITION":0}}]}])");
  const auto compiled = Scene::compile(scene(text));
  ASSERT_TRUE(compiled) << compiled.error().message();
  EXPECT_THAT((*compiled)->warnings, testing::Contains(HasSubstr("1 triangle without area left out")));
}

TEST_F(LoadGltfStrange, RefusesAllThatIsCutOff) {
  const std::string whole = kGlb;
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_NE(refusal(whole.substr(0, size), "a.glb"), "none") << size << " bytes";
}

// A byte more or less makes a message, or another scene: never an end of the program.
TEST_F(LoadGltfStrange, SurvivesAnyByteBeingAnother) {
  GltfText text;
  const int picture = text.view("\xff\xd8\xff no picture");
  text.set("images", fmt::format(R"([{{"bufferView":{}}}])", picture)).set("textures", R"([{"source":0}])");
  text.set("materials", R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])");
  const int indices =
      text.accessor(text.view(test::littleEndian<std::uint8_t>({0, 1, 2})), test::kUbyte, 3, "SCALAR");
  text.triangle("", fmt::format(R"(,"material":0,"indices":{})", indices));
  const std::string whole = text.glb();
  int readings = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const int flip : {0x01, 0x80, 0xff}) {
      std::string damaged = whole;
      damaged[i] = static_cast<char>(damaged[i] ^ flip);
      const std::string message = refusal(damaged, "a.glb");
      readings += message == "none" ? 1 : 0;
      EXPECT_FALSE(message.empty()) << i;
    }
  }
  EXPECT_GT(readings, 0) << "what is in strings and numbers may be another";
}

}  // namespace
}  // namespace lightvane

#include "sim/world/target/ply_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "tests/unit/sim/world/target/mesh_measures.hpp"
#include "tests/unit/sim/world/target/refused_text.hpp"

namespace tumblesight::sim {
namespace {

const MeshFileOptions kAsIs{MeshUp::kZ, 1.0};

std::string header(const std::string& format, const std::string& type = "float",
                   const std::string& faces = "2") {
  return "ply\nformat " + format + " 1.0\ncomment by a scanner\nobj_info none\nelement vertex 4\nproperty " +
         type + " x\nproperty " + type + " y\nproperty uchar red\nproperty " + type +
         " z\nelement range_grid 1\n"
         "property list uchar int vertex_indices\nelement face " +
         faces + "\nproperty uchar flags\nproperty list uchar int vertex_indices\nend_header\n";
}

const std::string kBody = "0 0 255 0\n1 0 255 0\n1 1 255 0\n0 1 255 0\n2 7 7\n0 3 0 1 2\n0 3 0 2 3\n";

template <typename T>
void put(std::string& bytes, T value, bool big_endian) {
  char raw[sizeof(T)];
  std::copy_n(reinterpret_cast<const char*>(&value), sizeof(T), raw);
  if (big_endian) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

template <typename T>
std::string binary_body(bool big_endian) {
  std::string bytes;
  for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
    put(bytes, static_cast<T>(x), big_endian);
    put(bytes, static_cast<T>(y), big_endian);
    bytes += '\xff';
    put(bytes, T{0}, big_endian);
  }
  bytes += '\1';
  put(bytes, std::int32_t{7}, big_endian);
  for (const auto& corners : {std::array{0, 1, 2}, {0, 2, 3}}) {
    bytes += std::string("\0\3", 2);
    for (const int corner : corners) put(bytes, std::int32_t{corner}, big_endian);
  }
  return bytes;
}

void expect_square(const std::string& bytes) {
  const TriangleMesh mesh = read_ply(bytes, kAsIs);
  EXPECT_EQ(mesh.triangles.size(), 2U);
  EXPECT_NEAR(area_m2(mesh), 1.0, 1e-6);
  EXPECT_TRUE(mesh.notes.empty());
}

void expect_refused(const std::string& bytes, const std::vector<std::string>& parts) {
  expect_refusal([&] { (void)read_ply(bytes, kAsIs); }, parts);
}

TEST(PlyFile, IsReadInAllFormatsAndTypes) {
  for (const char* type : {"float", "double", "char", "uint8", "int16", "ushort", "int", "uint32", "float64"})
    expect_square(header("ascii", type) + kBody);
  for (const bool big : {false, true}) {
    const std::string format = big ? "binary_big_endian" : "binary_little_endian";
    expect_square(header(format, "float") + binary_body<float>(big));
    expect_square(header(format, "double") + binary_body<double>(big));
    expect_square(header(format, "short") + binary_body<std::int16_t>(big));
    expect_square(header(format, "uchar") + binary_body<std::uint8_t>(big));
  }
}

TEST(PlyFile, BothNamesOfTheListAndLinesOfWindowsAreRead) {
  std::string text = header("ascii") + kBody;
  text.replace(text.rfind("vertex_indices"), 14, "vertex_index");
  expect_square(text);
  std::string of_windows;
  for (const char c : text) of_windows += c == '\n' ? "\r\n" : std::string(1, c);
  expect_square(of_windows);
}

TEST(PlyFile, PolygonsAreDividedAndShortFacesCounted) {
  const TriangleMesh mesh =
      read_ply(header("ascii") + kBody.substr(0, kBody.find("0 3")) + "0 4 0 1 2 3\n0 2 0 1\n", kAsIs);
  EXPECT_EQ(mesh.triangles.size(), 2U);
  ASSERT_EQ(mesh.notes.size(), 1U);
  EXPECT_NE(mesh.notes.front().find("1 face"), std::string::npos) << mesh.notes.front();
}

TEST(PlyFile, ACloudIsRefusedWithWhatToDo) {
  expect_refused(header("ascii", "float", "0") + kBody,
                 {"cloud of 4 points", "without faces", "surface", "Poisson"});
}

TEST(PlyFile, AFileThatIsCutOffAnywhereIsRefused) {
  for (const std::string& whole :
       {header("ascii") + kBody, header("binary_little_endian") + binary_body<float>(false)}) {
    for (std::size_t bytes = 4; bytes + 2 < whole.size(); ++bytes)
      EXPECT_THROW((void)read_ply(whole.substr(0, bytes), kAsIs), std::runtime_error) << bytes;
  }
  const std::string whole = header("binary_little_endian") + binary_body<float>(false);
  expect_refused(whole.substr(0, whole.size() - 3), {"entry 2 of the 2", "'face'", "cut off"});
  expect_refused(whole.substr(0, whole.size() - 40), {"cut off"});
  expect_refused(header("ascii").substr(0, 60), {"end_header", "cut off"});
}

TEST(PlyFile, ACutWithinTheLastNumberIsRefused) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 12\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 12; ++i) text += std::to_string(i) + " 0 " + std::to_string(i * i) + "\n";
  expect_refused(text + "3 3 11 4\n3 3 4 1", {"cut off", "vertex 1,"});
  EXPECT_EQ(read_ply(text + "3 3 11 4\n3 3 4 11", kAsIs).triangles.size(), 2U);
  EXPECT_EQ(read_ply(text + "3 3 11 4\n3 3 4 1\n", kAsIs).triangles.size(), 2U) << "the line is whole";
}

TEST(PlyFile, MoreThanTheHeaderAnnouncesIsRefused) {
  expect_refused(header("ascii", "float", "1") + kBody, {"announces 1 entry of element 'face'", "9 bytes"});
  for (const bool big : {false, true}) {
    const std::string format = big ? "binary_big_endian" : "binary_little_endian";
    expect_refused(header(format, "float", "1") + binary_body<float>(big),
                   {"announces 1 entry of element 'face'", "14 bytes"});
  }
}

TEST(PlyFile, BytesThatAreNoEntryAreANote) {
  const std::string binary = header("binary_little_endian") + binary_body<float>(false);
  for (const std::string& whole :
       {header("ascii") + kBody + "end of file\n", binary + "end\n", binary + std::string(512, '\0')}) {
    const TriangleMesh mesh = read_ply(whole, kAsIs);
    EXPECT_EQ(mesh.triangles.size(), 2U);
    ASSERT_EQ(mesh.notes.size(), 1U);
    EXPECT_NE(mesh.notes.front().find("after the last element"), std::string::npos) << mesh.notes.front();
  }
  expect_square(header("ascii") + kBody + " \n\t\n\n");
}

// Further numbers on one line shift those that are read. Those on every line are a property that the header
// forgot.
TEST(PlyFile, LinesWithMoreNumbersThanAnnouncedAreNotReadAsWhole) {
  const auto with = [](const std::string& part, const std::string& other) {
    std::string text = header("ascii") + kBody;
    return text.replace(text.find(part), part.size(), other);
  };
  expect_refused(with("0 3 0 1 2\n", "0 3 0 0 1 2\n"), {"line 21", "'face'", "1 of its 2", "more numbers"});
  expect_refused(with("1 1 255 0\n", "1 1 255 0 9\n"), {"line 18", "'vertex'", "1 of its 4"});
  const TriangleMesh mesh = read_ply(with("0 3 0 1 2\n0 3 0 2 3\n", "0 3 0 1 2 9\n0 3 0 2 3 9\n"), kAsIs);
  EXPECT_EQ(mesh.triangles.size(), 2U);
  ASSERT_EQ(mesh.losses.size(), 1U);
  EXPECT_NE(mesh.losses.front().find("'face'"), std::string::npos) << mesh.losses.front();
}

TEST(PlyFile, CountsThatTheFileCannotHoldReserveNothing) {
  expect_refused(header("ascii", "float", "4000000000") + kBody, {"4000000000", "'face'"});
  expect_refused(header("binary_big_endian", "float", "3999999999") + kBody, {"3999999999", "'face'"});
  std::string many = header("ascii") + kBody;
  many.replace(many.find("vertex 4"), 8, "vertex 99999999");
  expect_refused(many, {"99999999", "15000000"});
}

TEST(PlyFile, WhatIsWrongIsNamed) {
  const auto with = [](const std::string& part, const std::string& other) {
    std::string text = header("ascii") + kBody;
    return text.replace(text.find(part), part.size(), other);
  };
  expect_refused(with("0 3 0 1 2", "0 3 0 1 9"), {"face 1", "vertex 9", "0 to 3"});
  expect_refused(with("0 3 0 1 2", "0 3 0 1 -1"), {"'face'", "entry 1", "-1"});
  expect_refused(with("1 1 255 0", "1 nan 255 0"), {"2 of 6", "not finite", "face 1"});
  expect_refused(with("1 1 255 0", "1 1,5 255 0"), {"line 18", "'1,5'", "decimal point"});
  expect_refused(with("property float z", "property float w"), {"'vertex'", "'z'"});
  expect_refused(with("property float z", "property quad z"), {"line 9", "'quad'"});
  expect_refused(with("format ascii", "format " + std::string(9000, 'q')), {"line 2", "'qqq"});
  expect_refused(with("element range_grid", "element tristrips"), {"strips"});
  expect_refused("solid a\n", {"begins with the line 'ply'"});
}

}  // namespace
}  // namespace tumblesight::sim

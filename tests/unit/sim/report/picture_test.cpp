#include "sim/report/picture.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <stdexcept>

namespace tumblesight::sim {
namespace {

Picture decode_png(const std::vector<std::uint8_t>& bytes) {
  png_image description{};
  description.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&description, bytes.data(), bytes.size()) == 0) return {};
  description.format = PNG_FORMAT_RGB;
  Picture picture{static_cast<int>(description.width), static_cast<int>(description.height), {}};
  picture.pixels.resize(std::size_t{description.width} * description.height);
  if (png_image_finish_read(&description, nullptr, picture.pixels.data(), 0, nullptr) == 0) return {};
  return picture;
}

double brightness(const Rgb& colour) {
  return 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2];
}

TEST(Png, KeepsEveryPixel) {
  Picture picture{7, 5, {}};
  for (int i = 0; i < 35; ++i) {
    picture.pixels.push_back({static_cast<std::uint8_t>(7 * i), static_cast<std::uint8_t>(255 - i), 3});
  }
  const Picture decoded = decode_png(encode_png(picture));
  EXPECT_EQ(decoded.width, 7);
  EXPECT_EQ(decoded.height, 5);
  EXPECT_EQ(decoded.pixels, picture.pixels);
}

TEST(Png, RefusesPixelsThatDoNotFillThePicture) {
  EXPECT_THROW(encode_png({3, 3, std::vector<Rgb>(8)}), std::invalid_argument);
  EXPECT_THROW(encode_png({0, 0, {}}), std::invalid_argument);
}

TEST(Base64, MatchesTheExamplesOfRfc4648) {
  const auto encoded = [](const std::string& text) { return base64({text.begin(), text.end()}); };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(ColourMap, GrowsBrighterAllTheWay) {
  for (int i = 1; i <= 50; ++i) {
    EXPECT_GT(brightness(sequential_colour(i / 50.0)), brightness(sequential_colour((i - 1) / 50.0))) << i;
  }
  EXPECT_EQ(sequential_colour(-1.0), sequential_colour(0.0));
  EXPECT_EQ(sequential_colour(2.0), sequential_colour(1.0));
}

TEST(DepthPicture, ShowsNearCellsBrighterAndEmptyOnesApart) {
  gnc::DepthImage image;
  image.depth[0] = 20000;
  image.depth[1] = 45000;
  const Picture picture = depth_picture(image);
  ASSERT_EQ(picture.pixels.size(), image.depth.size());
  EXPECT_EQ(picture.pixels[0], sequential_colour(0.0));
  EXPECT_EQ(picture.pixels[1], sequential_colour(1.0));
  EXPECT_NE(picture.pixels[2], picture.pixels[0]);
  EXPECT_NE(picture.pixels[2], picture.pixels[1]);
}

}  // namespace
}  // namespace tumblesight::sim

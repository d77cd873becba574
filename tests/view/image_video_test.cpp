#include <gtest/gtest.h>
#include <sys/mount.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>

#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "runtime/picture/image.h"
#include "runtime/view/video.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test, removed afterwards.
struct InFolder : testing::Test {
  fs::path folder = fs::path(testing::TempDir()) / ("liana view " + std::to_string(getpid()));
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  size_t files() const {
    return size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
};
using ImageFile = InFolder;
using Video = InFolder;

Image gradient(int width, int height, int shift = 0) {
  Image image{width, height, std::vector<uint8_t>(size_t(width) * height * 3)};
  for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = uint8_t(i / 3 % width + i % 3 + shift);
  return image;
}

std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  for (int c; pipe && (c = std::fgetc(pipe)) != EOF;) text += char(c);
  if (pipe) pclose(pipe);
  return text;
}

TEST_F(ImageFile, PngKeepsEveryPixelAndLeavesNothingElse) {
  const Image image = gradient(67, 31);
  write_png(folder / "a.png", image);
  EXPECT_EQ(read_png(folder / "a.png").pixels, image.pixels);
  EXPECT_EQ(files(), 1u);
}

TEST_F(ImageFile, BrokenPngIsAnInputError) {
  write_png(folder / "a.png", gradient(67, 31));
  const std::string bytes = read_file(folder / "a.png");
  for (const size_t size : {size_t{0}, size_t{5}, size_t{30}, bytes.size() / 2}) {
    write_file(folder / "b.png", std::string_view(bytes).substr(0, size));
    EXPECT_THROW(read_png(folder / "b.png"), Error) << size;
  }
}

TEST_F(ImageFile, UnwritableFolderIsAnOutputError) {
  try {
    write_png(folder / "missing" / "a.png", gradient(4, 4));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, Error::Kind::Output);
  }
}

TEST(ImageDifference, IsTheRootMeanSquareOfTheChannels) {
  Image a{2, 1, {10, 10, 10, 10, 10, 10}}, b{2, 1, {10, 10, 10, 10, 10, 16}};
  EXPECT_DOUBLE_EQ(root_mean_square_difference(a, b), std::sqrt(36.0 / 6));
  EXPECT_EQ(root_mean_square_difference(a, a), 0);
}

TEST_F(Video, HoldsEveryFrameAndAppearsOnlyWhenFinished) {
  const fs::path path = folder / "a.mp4";
  VideoWriter video(path, 128, 64, 25);
  for (int i = 0; i < 30; ++i) video.add(gradient(128, 64, 4 * i));
  EXPECT_FALSE(fs::exists(path));
  video.finish();
  EXPECT_EQ(files(), 1u);
  const std::string told = output_of(
      "ffprobe -v error -count_frames -show_entries "
      "stream=codec_name,width,height,nb_read_frames,r_frame_rate "
      "-of csv=p=0 '" +
      path.string() + "'");
  EXPECT_EQ(told, "h264,128,64,25/1,30\n");
}

TEST_F(Video, UnfinishedLeavesNothing) {
  {
    VideoWriter video(folder / "a.mp4", 64, 64, 25);
    video.add(gradient(64, 64));
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(Video, DyingFfmpegIsAnErrorNotADeath) {
  // An ffmpeg that says why and ends at once, while frames larger than a pipe are still being written.
  write_file(folder / "ffmpeg", "#!/bin/sh\necho no space left >&2\nexit 1\n");
  fs::permissions(folder / "ffmpeg", fs::perms::owner_all);
  const std::string before = getenv("PATH");
  setenv("PATH", (folder.string() + ":" + before).c_str(), 1);
  try {
    VideoWriter video(folder / "a.mp4", 640, 480, 25);
    for (int i = 0; i < 20; ++i) video.add(gradient(640, 480));
    video.finish();
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no space left"), std::string::npos) << error.what();
  }
  setenv("PATH", before.c_str(), 1);
  EXPECT_FALSE(fs::exists(folder / "a.mp4"));
  EXPECT_EQ(files(), 1u);
}

TEST_F(Video, FullDiskIsAnErrorAndLeavesNothing) {
  // One page. Noise does not compress; three frames of it wait in ffmpeg's buffer of 32 kB until its last
  // write.
  if (mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=4k") != 0)
    GTEST_SKIP() << "mounting is not allowed here";
  std::mt19937 random(1);
  Image noise = gradient(64, 64);
  for (const int frames : {3, 60}) try {
      VideoWriter video(folder / "a.mp4", noise.width, noise.height, 25);
      for (int i = 0; i < frames; ++i) {
        for (uint8_t& channel : noise.pixels) channel = static_cast<uint8_t>(random());
        video.add(noise);
      }
      video.finish();
      ADD_FAILURE() << frames;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, Error::Kind::Output);
      EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
    }
  EXPECT_EQ(files(), 0u);
  umount(folder.c_str());
}

TEST_F(Video, MissingFfmpegNamesThePackage) {
  const std::string before = getenv("PATH");
  setenv("PATH", folder.c_str(), 1);
  try {
    VideoWriter video(folder / "a.mp4", 64, 64, 25);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(error.hint.find("package ffmpeg"), std::string::npos);
  }
  setenv("PATH", before.c_str(), 1);
  EXPECT_EQ(files(), 0u);
}

TEST_F(Video, BadSizesAndRatesAreUsageErrors) {
  EXPECT_THROW(VideoWriter(folder / "a.mp4", 63, 64, 25), Error);
  EXPECT_THROW(VideoWriter(folder / "a.mp4", 0, 64, 25), Error);
  EXPECT_THROW(VideoWriter(folder / "a.mp4", 64, 64, 0), Error);
  EXPECT_THROW(VideoWriter(folder / "a.mp4", 64, 64, std::nan("")), Error);
}

}  // namespace
}  // namespace liana

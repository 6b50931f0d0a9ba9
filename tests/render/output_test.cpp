// Pictures and videos on disk: whole, or not there.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/child_process.h"
#include "render/output_file.h"
#include "render/png_writer.h"
#include "render/video_writer.h"
#include "tests/render/picture.h"

namespace sheave::render {
namespace {

namespace fs = std::filesystem;

/// A folder that lives as long as the test.
struct Output : testing::Test {
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "sheave_render_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder = name;
  }
  void TearDown() override {
    fs::permissions(folder, fs::perms::owner_all);
    fs::remove_all(folder);
  }
  [[nodiscard]] std::string file(const char* name) const { return (folder / name).string(); }
  [[nodiscard]] int file_count() const {
    return static_cast<int>(std::distance(fs::directory_iterator(folder), {}));
  }
  fs::path folder;
};

std::string content(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A gradient with a moving square, so that frames differ.
Image test_frame(int width, int height, int time) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::uint8_t* p = image.pixel(x, y);
      const bool inside = x >= 2 * time && x < 2 * time + height / 3 && y > height / 3;
      p[0] = static_cast<std::uint8_t>(inside ? 220 : 255 * x / width);
      p[1] = static_cast<std::uint8_t>(inside ? 60 : 255 * y / height);
      p[2] = inside ? 40 : 128;
    }
  }
  return image;
}

bool has_ffmpeg() {
  auto child = ChildProcess::start({"ffmpeg", "-version"});
  return child && child->finish().empty();
}

TEST_F(Output, PngRoundTrips) {
  const Image image = test_frame(37, 21, 3);
  for (const PngEffort effort : {PngEffort::sequence, PngEffort::still}) {
    ASSERT_TRUE(write_png(file("a.png"), image, effort).empty());
    const auto read = test::read_png(file("a.png"));
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, image);
  }
  EXPECT_EQ(file_count(), 1);
  // As readable as any file the user makes.
  EXPECT_NE(fs::status(file("a.png")).permissions() & fs::perms::owner_read, fs::perms::none);
}

TEST_F(Output, PngOfNothingIsAnError) {
  const Errors errors = write_png(file("a.png"), Image());
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NE(errors[0].message.find("0 x 0"), std::string::npos);
  Image wrong(4, 4);
  wrong.rgb.pop_back();
  EXPECT_FALSE(write_png(file("a.png"), wrong).empty());
  EXPECT_EQ(file_count(), 0);
}

TEST_F(Output, MissingFolderIsNamed) {
  const Errors errors = write_png(file("none/a.png"), Image(2, 2));
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NE(errors[0].message.find("none/a.png"), std::string::npos);
  EXPECT_NE(errors[0].message.find("No such file"), std::string::npos);
  EXPECT_FALSE(write_png(folder.string(), Image(2, 2)).empty());
  EXPECT_FALSE(write_png("", Image(2, 2)).empty());
}

TEST_F(Output, FileAppearsOnlyWhenCommitted) {
  const std::array<std::uint8_t, 3> bytes{'a', 'b', 'c'};
  {
    auto half = OutputFile::create(file("x.txt"));
    ASSERT_TRUE(half);
    ASSERT_TRUE(half->write(bytes).empty());
    EXPECT_FALSE(fs::exists(file("x.txt")));
  }
  EXPECT_EQ(file_count(), 0);
  ASSERT_TRUE(write_file(file("x.txt"), bytes).empty());
  EXPECT_EQ(content(file("x.txt")), "abc");
  // What was there stays until the new file is whole.
  auto next = OutputFile::create(file("x.txt"));
  ASSERT_TRUE(next);
  EXPECT_EQ(content(file("x.txt")), "abc");
  OutputFile moved = std::move(*next);
  ASSERT_TRUE(moved.commit().empty());
  EXPECT_EQ(content(file("x.txt")), "");
  EXPECT_EQ(file_count(), 1);
}

TEST_F(Output, FullDiskIsReported) {
  const Errors errors = write_file("/dev/full/x", std::array<std::uint8_t, 1>{1});
  EXPECT_FALSE(errors.empty());
}

TEST_F(Output, VideoHasItsFramesAndColours) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  constexpr int width = 96;
  constexpr int height = 64;
  auto video = VideoWriter::create(file("v.mp4"), width, height, {.frames_per_second = 30});
  ASSERT_TRUE(video) << video.errors()[0].message;
  for (int t = 0; t < 10; ++t) ASSERT_TRUE(video->add(test_frame(width, height, t)).empty());
  EXPECT_EQ(video->frame_count(), 10);
  EXPECT_FALSE(fs::exists(file("v.mp4")));
  const Errors errors = video->finish();
  ASSERT_TRUE(errors.empty()) << errors[0].message;
  EXPECT_EQ(file_count(), 1);
  const std::string bytes = content(file("v.mp4"));
  // The index stands before the frames, so that playing can start while loading.
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
  EXPECT_EQ(bytes.find("Lavf"), std::string::npos);

  const std::string command = "ffmpeg -nostdin -loglevel error -i '" + file("v.mp4") +
                              "' -f rawvideo -pix_fmt rgb24 '" + file("raw") + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string raw = content(file("raw"));
  ASSERT_EQ(raw.size(), std::size_t{10} * width * height * 3);
  double difference = 0.0;
  const Image last = test_frame(width, height, 9);
  for (std::size_t i = 0; i < last.rgb.size(); ++i) {
    const auto shown = static_cast<unsigned char>(raw[raw.size() - last.rgb.size() + i]);
    difference += std::abs(static_cast<double>(shown) - last.rgb[i]);
  }
  // Compression blurs colours at edges; a wrong matrix would shift all of them by 10 and more.
  EXPECT_LT(difference / static_cast<double>(last.rgb.size()), 4.0);
}

TEST_F(Output, VideoIsDeterministicAndTakesOddSizes) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  for (const char* name : {"a.mp4", "b.mp4"}) {
    auto video = VideoWriter::create(file(name), 95, 63);
    ASSERT_TRUE(video);
    for (int t = 0; t < 30; ++t) ASSERT_TRUE(video->add(test_frame(95, 63, t)).empty());
    const Errors errors = video->finish();
    ASSERT_TRUE(errors.empty()) << errors[0].message;
  }
  EXPECT_EQ(content(file("a.mp4")), content(file("b.mp4")));
  EXPECT_FALSE(content(file("a.mp4")).empty());
}

TEST_F(Output, DiscardedVideoLeavesNothing) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  {
    auto video = VideoWriter::create(file("v.mp4"), 64, 64);
    ASSERT_TRUE(video);
    ASSERT_TRUE(video->add(test_frame(64, 64, 0)).empty());
  }
  {
    auto empty = VideoWriter::create(file("w.mp4"), 64, 64);
    ASSERT_TRUE(empty);
    EXPECT_NE(empty->finish().front().message.find("no frames"), std::string::npos);
    EXPECT_FALSE(empty->add(test_frame(64, 64, 0)).empty());
    EXPECT_FALSE(empty->finish().empty());
  }
  EXPECT_EQ(file_count(), 0);
}

TEST_F(Output, MissingEncoderIsNamed) {
  const auto video =
      VideoWriter::create(file("v.mp4"), 64, 64, {.program = "no-such-encoder-anywhere"});
  ASSERT_FALSE(video);
  EXPECT_NE(video.errors()[0].message.find("no-such-encoder-anywhere"), std::string::npos);
  EXPECT_NE(video.errors()[0].message.find("apt install ffmpeg"), std::string::npos);
  EXPECT_EQ(file_count(), 0);
}

TEST_F(Output, EncoderThatDiesIsAnErrorNotASignal) {
  // `false` ends without reading; writing to it must not raise SIGPIPE.
  auto video = VideoWriter::create(file("v.mp4"), 640, 480, {.program = "false"});
  ASSERT_TRUE(video);
  Errors errors;
  for (int t = 0; t < 50 && errors.empty(); ++t) errors = video->add(Image(640, 480));
  EXPECT_FALSE(errors.empty());
  video->discard();
  EXPECT_EQ(file_count(), 0);

  auto quiet = VideoWriter::create(file("v.mp4"), 2, 2, {.program = "false"});
  ASSERT_TRUE(quiet);
  errors = quiet->add(Image(2, 2));
  if (errors.empty()) errors = quiet->finish();
  ASSERT_FALSE(errors.empty());
  EXPECT_NE(errors[0].message.find("v.mp4"), std::string::npos);
  quiet->discard();
  EXPECT_EQ(file_count(), 0);
}

/// An encoder made of a shell script; "$@" are the arguments, of which the last names the file.
std::string script(const std::string& path, const std::string& lines) {
  std::ofstream(path) << "#!/bin/sh\nfor last; do :; done\nout=${last#file:}\n" << lines;
  fs::permissions(path, fs::perms::owner_all);
  return path;
}

/// On a busy machine an encoder may do nothing for a while and yet not hang.
Errors video_of(const std::string& path, const std::string& program, int frames,
                double stall_seconds = 600.0) {
  auto video = VideoWriter::create(
      path, 64, 48, {.frames_per_second = 50, .program = program, .stall_seconds = stall_seconds});
  if (!video) return video.errors();
  Errors errors;
  for (int t = 0; t < frames && errors.empty(); ++t) errors = video->add(test_frame(64, 48, t));
  return errors.empty() ? video->finish() : errors;
}

TEST_F(Output, AnEncoderThatEndsWellButLeavesNoVideoIsAnError) {
  const struct {
    const char* lines;
    const char* message;
  } encoders[]{
      {"cat >/dev/null\n", "the file is empty"},
      {"cat >\"$out\"\n", "the file is no video"},
      {"ffmpeg \"$@\"; truncate -s -1 \"$out\"\n", "ends early"},
      {"ffmpeg \"$@\"; truncate -s 300 \"$out\"\n", "ends early"},
      {"ffmpeg \"$@\"; truncate -s 0 \"$out\"\n", "empty"},
      {"rm \"$out\"; cat >/dev/null\n", "cannot be read"},
      {"cat >/dev/null; echo no space >&2\n", "no space"},
      {"head -c 92160 | ffmpeg \"$@\"\n", ""},
  };
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  for (const char* name : {"v.mp4", "v.mkv", "v.mov", "v.gif"}) {
    for (const auto& encoder : encoders) {
      // The last one is given up by its writer, or leaves the 10 frames that it read.
      const std::string program = script(file("encoder"), encoder.lines);
      const Errors errors = video_of(file(name), program, 30);
      ASSERT_FALSE(errors.empty()) << name << ": " << encoder.lines;
      EXPECT_NE(errors[0].message.find(encoder.message), std::string::npos) << errors[0].message;
      EXPECT_NE(errors[0].message.find(name), std::string::npos) << errors[0].message;
      EXPECT_EQ(file_count(), 1) << "nothing but the script";
    }
    EXPECT_TRUE(video_of(file(name), script(file("encoder"), "exec ffmpeg \"$@\"\n"), 30).empty());
    fs::remove(file(name));
  }
}

TEST_F(Output, AGifHasTheColoursOfItsFrames) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  EXPECT_FALSE(VideoWriter::create(file("v.gif"), 64, 48, {.frames_per_second = 60}));
  // Red, then blue: the first frame has no blue, so the palette's own colours show it.
  auto video = VideoWriter::create(file("v.gif"), 64, 48, {.frames_per_second = 25});
  ASSERT_TRUE(video);
  for (const bool red : {true, false}) {
    Image image(64, 48);
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) image.rgb[i + (red ? 0 : 2)] = 200;
    ASSERT_TRUE(video->add(image).empty());
  }
  ASSERT_TRUE(video->finish().empty());
  EXPECT_EQ(content(file("v.gif")).substr(0, 6), "GIF89a");
  const std::string command = "ffmpeg -nostdin -loglevel error -i '" + file("v.gif") +
                              "' -vsync passthrough -f rawvideo -pix_fmt rgb24 '" + file("raw") +
                              "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string raw = content(file("raw"));
  ASSERT_EQ(raw.size(), std::size_t{2} * 64 * 48 * 3);
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(raw[at]); };
  // Colours of the first frame are exact to a few steps of 255. 255 others are six per channel, with
  // a largest distance of 255 / 6 / 2.
  EXPECT_NEAR(byte(0), 200, 8);
  EXPECT_NEAR(byte(2), 0, 8);
  EXPECT_NEAR(byte(raw.size() / 2), 0, 22);
  EXPECT_NEAR(byte(raw.size() / 2 + 2), 200, 22);
}

TEST_F(Output, AGifHoldsOnlyWhatChanges) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  // Noise does not compress: a frame of 96 x 96 pixels takes its 9 kB. Only a square of 12 x 12 of
  // it changes, a 64th.
  auto video = VideoWriter::create(file("v.gif"), 96, 96, {.frames_per_second = 25});
  ASSERT_TRUE(video);
  std::mt19937 random(3);
  Image image(96, 96);
  for (std::uint8_t& byte : image.rgb) byte = static_cast<std::uint8_t>(random() % 256);
  for (int frame = 0; frame < 50; ++frame) {
    for (int y = 0; y < 12; ++y) {
      for (int k = 0; k < 36; ++k)
        image.pixel(20, 30 + y)[k] = static_cast<std::uint8_t>(random() % 256);
    }
    ASSERT_TRUE(video->add(image).empty());
  }
  ASSERT_TRUE(video->finish().empty());
  // The first frame, and less than a fifth of a frame for each of the others.
  EXPECT_LT(fs::file_size(file("v.gif")), 12'000 + 50 * 2'000);
}

TEST_F(Output, AnEncoderThatHangsIsGivenUp) {
  const std::string program = script(file("encoder"), "exec sleep 1000000\n");
  // Few frames fit into what the system keeps for the encoder, so that it hangs at the end; many do
  // not.
  for (const int frames : {1, 1000}) {
    const Errors errors = video_of(file("v.mp4"), program, frames, 0.2);
    ASSERT_FALSE(errors.empty()) << frames;
    EXPECT_NE(errors[0].message.find("hangs"), std::string::npos) << errors[0].message;
    EXPECT_EQ(file_count(), 1);
  }
}

TEST_F(Output, ALinkStaysALinkAndADeviceIsNotReplaced) {
  fs::create_symlink("target.png", file("link.png"));
  for (int i = 0; i < 2; ++i) {  // the target is new, then it is there
    ASSERT_TRUE(write_png(file("link.png"), Image(2, 2)).empty());
    EXPECT_TRUE(fs::is_symlink(file("link.png")));
    EXPECT_TRUE(test::read_png(file("target.png")));
  }
  fs::create_symlink("/dev/null", file("null.png"));
  EXPECT_FALSE(write_png(file("null.png"), Image(2, 2)).empty());
  EXPECT_EQ(file_count(), 3);
}

TEST_F(Output, ImpossibleVideosAreRefused) {
  EXPECT_EQ(VideoWriter::create(file("v.avi"), 0, 70000, {.frames_per_second = -1.0, .quality = 99})
                .errors()
                .size(),
            4U);
  EXPECT_FALSE(VideoWriter::create(file("none/v.mp4"), 64, 64));
  if (!has_ffmpeg()) return;
  auto video = VideoWriter::create(file("v.mp4"), 64, 64);
  ASSERT_TRUE(video);
  EXPECT_NE(video->add(Image(32, 64)).front().message.find("32 x 64"), std::string::npos);
}

TEST(Child, LastWordsAreReported) {
  auto child = ChildProcess::start({"sh", "-c", "echo went wrong >&2; exit 3"});
  ASSERT_TRUE(child);
  const Errors errors = child->finish();
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].message, "'sh' ended with status 3: went wrong");
  auto killed = ChildProcess::start({"sh", "-c", "kill -9 $$"});
  ASSERT_TRUE(killed);
  EXPECT_EQ(killed->finish().front().message, "'sh' was ended by signal 9 (Killed)");
}

TEST(Child, OutputIsKeptIfAskedFor) {
  auto child = ChildProcess::start({"sh", "-c", "cat; echo $SHEAVE_A$SHEAVE_B"},
                                   {.keeps_output = true, .hidden_variables = {"SHEAVE_A"}});
  ASSERT_TRUE(child);
  EXPECT_TRUE(child->write(std::vector<std::uint8_t>{'a', '\0', 'b'}).empty());
  EXPECT_TRUE(child->finish().empty());
  EXPECT_EQ(child->output(), (std::vector<std::uint8_t>{'a', '\0', 'b', '\n'}));
}

TEST(Child, AMissingProgramIsReportedWithItsRemedy) {
  const auto child = ChildProcess::start({"no-such-program-here"}, {.if_missing = "install it"});
  ASSERT_FALSE(child);
  EXPECT_EQ(
      child.errors()[0].message,
      "cannot start the program 'no-such-program-here': No such file or directory; install it");
}

/// Whether a process has ended, waited for or not.
bool has_ended(const std::string& process) {
  std::ifstream file("/proc/" + process + "/stat");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return text.empty() || text.find(") Z ") != std::string::npos;
}

TEST(Child, ItsChildrenEndWithTheProgram) {
  // Ends by itself, is ended, and is destroyed.
  for (const int way : {0, 1, 2}) {
    std::string grandchild;
    {
      auto child = ChildProcess::start(
          {"sh", "-c",
           way == 0 ? "sleep 100000 & echo $!" : "sleep 100000 & echo $!; sleep 100000"},
          {.keeps_output = true});
      ASSERT_TRUE(child);
      while (child->output().empty()) ::usleep(1000);
      const std::vector<std::uint8_t> said = child->output();
      grandchild.assign(said.begin(), said.end() - 1);
      if (way == 0) {
        EXPECT_TRUE(child->finish().empty());
      }
      if (way == 1) child->kill();
    }
    while (!has_ended(grandchild)) ::usleep(1000);
  }
}

/// The first message; empty without one.
std::string fault_text(const Errors& errors) {
  return errors.empty() ? std::string() : errors.front().message;
}

TEST(Child, OutputWithoutEndIsAnError) {
  for (const char* const script : {"yes", "yes >&2", "yes & wait"}) {
    auto child = ChildProcess::start({"sh", "-c", script},
                                     {.most_output = std::size_t{1} << 20U, .keeps_output = true});
    ASSERT_TRUE(child);
    EXPECT_THAT(fault_text(child->finish()), testing::HasSubstr("writes without end")) << script;
  }
}

TEST(Child, AHangingProgramGetsLessTimeWhenHurried) {
  // Without the hurry the test would last an hour.
  auto child = ChildProcess::start(
      {"sleep", "100000"},
      {.stall_seconds = 3600.0, .hurry = [] { return true; }, .hurried_stall_seconds = 0.1});
  ASSERT_TRUE(child);
  EXPECT_THAT(fault_text(child->finish()), testing::HasSubstr("hangs"));
}

TEST(Child, NamesTheSignalThatEndsAProgram) {
  auto large = ChildProcess::start({"sh", "-c", "echo other words >&2; kill -XFSZ $$"});
  ASSERT_TRUE(large);
  const std::string told = fault_text(large->finish());
  EXPECT_THAT(told, testing::HasSubstr("File too large"));
  EXPECT_THAT(told, testing::Not(testing::HasSubstr("other words")));
  auto crashed = ChildProcess::start({"sh", "-c", "kill -SEGV $$"});
  ASSERT_TRUE(crashed);
  EXPECT_THAT(fault_text(crashed->finish()), testing::HasSubstr("Segmentation fault"));
}

TEST(Child, ATalkativeProgramDoesNotBlock) {
  auto child = ChildProcess::start({"sh", "-c", "head -c 1000000 /dev/zero >&2; cat >/dev/null"});
  ASSERT_TRUE(child);
  EXPECT_TRUE(child->write(std::vector<std::uint8_t>(1000000)).empty());
  EXPECT_TRUE(child->finish().empty());
}

}  // namespace
}  // namespace sheave::render

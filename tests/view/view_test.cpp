// Packing and cutting lines into pieces. What the page reads back is compared with tables by
// web/tests/scenes.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "view/line_tracks.h"
#include "view/recording_pack.h"

namespace sheave::view {
namespace {

TEST(Base64, FollowsRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::string("\xff\x00\xfe", 3)), "/wD+");
}

TEST(LineTracks, HaveAllFramesWithGapsWhereALineIsMissing) {
  LineTracks tracks;
  const std::vector<Vector3> line{Vector3::Zero(), Vector3::UnitX()};
  tracks.begin_frame();
  tracks.put("early", 0.1, {}, line, 1.0);
  tracks.begin_frame();
  tracks.put("late", 0.2, {}, line, 2.0);
  tracks.begin_frame();
  const std::vector<LineTrack> all = tracks.finish();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].name, "early");
  EXPECT_EQ(all[0].lines.size(), 3U);
  EXPECT_THAT(all[0].lines[1], testing::IsEmpty());
  EXPECT_THAT(all[1].lines[0], testing::IsEmpty());
  EXPECT_EQ(all[1].tensions, (std::vector<double>{0.0, 2.0, 0.0}));
  EXPECT_EQ(all[1].piece_count(), 1U);
}

TEST(LineTracks, PiecesAreEvenAlongTheLine) {
  LineTrack track;
  // Two metres along x, then one along y, in steps of different lengths.
  track.lines = {{Vector3::Zero(), {0.5, 0.0, 0.0}, {2.0, 0.0, 0.0}, {2.0, 1.0, 0.0}}};
  const std::vector<Vector3> ends = track.piece_ends(0, 3);
  ASSERT_EQ(ends.size(), 4U);
  // Sums of a few numbers near 1.
  constexpr double rounding = 1e-14;
  EXPECT_LT((ends[0] - Vector3::Zero()).norm(), rounding);
  EXPECT_LT((ends[1] - Vector3(1.0, 0.0, 0.0)).norm(), rounding);
  EXPECT_LT((ends[2] - Vector3(2.0, 0.0, 0.0)).norm(), rounding);
  EXPECT_LT((ends[3] - Vector3(2.0, 1.0, 0.0)).norm(), rounding);
}

}  // namespace
}  // namespace sheave::view

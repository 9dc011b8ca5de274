#include "source_video/v4l2_source.hpp"
#include "source_video/video_file_source.hpp"

STILLPOINT_PLUGIN(
    source_video, "0.1.0",
    stillpoint::provide<stillpoint::Source, stillpoint::source_video::VideoFileSource>(
        "video_file", "colour from a video file, depth from a folder of 16-bit PNGs"),
    stillpoint::provide<stillpoint::Source, stillpoint::source_video::V4l2Source>(
        "v4l2", "colour and 16-bit depth of two devices of V4L2, live"));

#include "segmenter_segnet/segnet_segmenter.hpp"

STILLPOINT_PLUGIN(
    segmenter_segnet, "0.1.0",
    stillpoint::provide<stillpoint::Segmenter, stillpoint::segmenter_segnet::SegnetSegmenter>(
        "segnet", "SegNet from its published Caffe files, through OpenCV DNN"));

#include "segmenter_opencv_dnn/opencv_dnn_segmenter.hpp"

STILLPOINT_PLUGIN(segmenter_opencv_dnn, "0.1.0",
                  stillpoint::provide<stillpoint::Segmenter,
                                      stillpoint::segmenter_opencv_dnn::OpenCvDnnSegmenter>(
                      "opencv_dnn", "any network that OpenCV reads (paper III-B)"));
